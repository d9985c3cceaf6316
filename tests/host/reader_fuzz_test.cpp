#include <doctest/doctest.h>

#include <fstream>

#include "tests/fuzz/reader_mutations.h"

using namespace etendue;

TEST_CASE("the files that mutations start from are read") {
    const TemporaryFolder folder;
    for (const FuzzedReader& reader : fuzzed_readers(folder)) {
        CAPTURE(reader.file);
        CHECK(try_read(reader, folder, reader.sound));
    }
}

TEST_CASE("three hundred damaged files of each kind are sound or give a one-line error each") {
    const TemporaryFolder folder;
    Random random(20240301);
    for (const FuzzedReader& reader : fuzzed_readers(folder)) {
        CAPTURE(reader.file);
        size_t sound = 0;
        for (int i = 0; i < 300; ++i) sound += try_read(reader, folder, mutated_file(reader, random));
        CHECK(sound > 0);
        CHECK(sound < 300);
    }
}

TEST_CASE("JSON that is nested without end is refused, and takes no stack") {
    const TemporaryFolder folder;
    const std::string deep = std::string(1000000, '[') + std::string(1000000, ']');
    write_text(folder / "deep.json",
               R"({"theta_i": [0], "theta_r": [0], "phi": [0, 180], "reflection": [[[)" + deep + ", 1]]]}");
    CHECK_THROWS_AS(read_measured_bsdf(folder / "deep.json"), Error);

    Checkpoint checkpoint;
    write_checkpoint(folder / "state", checkpoint);
    std::string bytes = read_text(folder / "state");
    const std::string header =
        R"({"identity": {"seed": )" + deep + R"(}, "passes": [], "about": {}, "arrays": []})";
    const uint32_t size = uint32_t(header.size());
    bytes.resize(16);
    std::memcpy(bytes.data() + 12, &size, sizeof size);
    bytes += header + std::string(8, '\0');
    seal_checkpoint(bytes);
    write_text(folder / "state", bytes);
    CHECK_THROWS_AS(read_checkpoint(folder / "state"), Error);
}

TEST_CASE("messages repeat what files say in a form that a terminal can show") {
    CHECK(printable("plain, é, Ω and 日本") == "plain, é, Ω and 日本");
    CHECK(printable("a\nb") == "a b");
    CHECK(printable("\x1b[2J") == "\\x1b[2J");
    CHECK(printable("\xff\xc3(") == "\\xff\\xc3(");
    CHECK(printable("\xc2\x9b") == "\\xc2\\x9b");           // a control of C1
    CHECK(printable("\xe2\x80\xae") == "\\xe2\\x80\\xae");  // turns the direction of what follows
    CHECK(printable("\xed\xa0\x80 \xc0\x80") == "\\xed\\xa0\\x80 \\xc0\\x80");  // surrogate, overlong
    CHECK(printable("\xe6\x97") == "\\xe6\\x97");                               // cut short

    const TemporaryFolder folder;
    write_text(folder / "x.nrrd", "NRRD0004\ntype: \x1b[31m\xff\ndimension: 3\nencoding: raw\n\n");
    try {
        read_density_file(folder / "x.nrrd", "");
        FAIL("it was read");
    } catch (const Error& e) {
        CHECK(std::string(e.what()).find("'type: \\x1b[31m\\xff'") != std::string::npos);
    }
}
