// Outputs of a run: each is written that can be, then the failures are one line.
#include "host/image/outputs.h"

#include <doctest/doctest.h>

using namespace etendue;

TEST_CASE("what can be written is, and the failures are told together with the code of the first") {
    Outputs outputs;
    bool written = false;
    CHECK(!outputs.write([] { fail_input("a.exr: full"); }));
    CHECK(outputs.write([&] { written = true; }));
    CHECK(!outputs.write([] { fail_device("the device was lost"); }));
    CHECK(!outputs.write([] { fail_input("a.exr: full"); }));  // once is enough
    CHECK(written);
    try {
        outputs.finish();
        FAIL("it succeeded");
    } catch (const Error& error) {
        CHECK(error.code == ExitCode::bad_input);
        CHECK(std::string(error.what()) == "a.exr: full; the device was lost");
    }
    CHECK_NOTHROW(Outputs().finish());
}
