// The command line: arguments to options, and one line with exit code 2 for what cannot be understood.
#pragma once
#include <filesystem>
#include <variant>

#include "host/commands.h"

namespace etendue {

struct DevicesOptions {};
struct TextAnswer {  // --help and --version
    std::string text;
};
using CommandLine =
    std::variant<TextAnswer, RenderOptions, MeasureOptions, MergeOptions, CompareOptions, BenchOptions,
                 ViewOptions, RaysOptions, InspectOptions, LensOptions, ClassesOptions, DevicesOptions>;

// Fails with one line (exit code 2) where the arguments are wrong.
CommandLine parse_command_line(int argc, const char* const* argv);

// SCENE's name with .exr, in the current folder.
std::filesystem::path default_output(const std::filesystem::path& scene);

}  // namespace etendue
