// What a scene may lack is a module with an empty twin (shaders/features), so that stages read as the
// algorithm does: none of them has an #if, and kernels and what they share choose by the direction of the
// paths alone.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "tests/support/source_path.h"

namespace {

struct Conditions {
    size_t files = 0;
    std::string other;  // than by direction: "file:line: text", a line each
};

// All conditions of the preprocessor in a folder of shaders but `#if FORWARD` and `#if !FORWARD`, where those
// are allowed.
Conditions conditions(const std::string& folder, bool allows_direction) {
    const std::regex condition(R"(^\s*#\s*(if|ifdef|ifndef|elif)\b.*)"),
        direction(R"(^\s*#if !?FORWARD\s*$)");
    Conditions found;
    for (const auto& entry : std::filesystem::directory_iterator(etendue::source_path("shaders/" + folder))) {
        std::ifstream file(entry.path());
        ++found.files;
        std::string line;
        for (int number = 1; std::getline(file, line); ++number)
            if (std::regex_match(line, condition) && !(allows_direction && std::regex_match(line, direction)))
                found.other +=
                    entry.path().filename().string() + ":" + std::to_string(number) + ": " + line + "\n";
    }
    return found;
}

}  // namespace

TEST_CASE("features are modules: no stage has an #if, kernels and lib files choose by direction alone") {
    const Conditions stages = conditions("stages", false);
    CHECK(stages.files >= 10);
    CHECK(stages.other == "");
    for (const char* folder : {"kernels", "lib", "interfaces"}) {
        const Conditions found = conditions(folder, true);
        CHECK(found.files >= 6);
        CHECK_MESSAGE(found.other == "", folder);
    }
}
