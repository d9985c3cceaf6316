// Entry of every test executable: runs the cases and then fails the run if the validation layer said
// anything.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "tests/support/device_fixture.h"

int main(int argc, char** argv) {
    doctest::Context context(argc, argv);
    int result = context.run();
    if (context.shouldExit()) return result;
    for (const std::string& message : etendue::collected_validation_messages()) {
        std::fprintf(stderr, "validation: %s\n", message.c_str());
        result = 1;
    }
    // Without the destructors of static objects: SwiftShader crashes where a device is destroyed after main.
    std::cout.flush();
    std::fflush(nullptr);
    std::_Exit(result);
}
