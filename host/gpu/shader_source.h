// Where shader text comes from: the copy embedded in the binary, a folder on disk (--shaders), text that the
// host generates for a scene, and class files that a scene brings along.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace etendue {

// Resolves the names that #include directives and kernels use.
struct ShaderSources {
    std::filesystem::path folder;                  // read before the embedded copy when not empty
    std::map<std::string, std::string> generated;  // name -> text, read before everything else

    std::optional<std::string> find(const std::string& name) const;
    std::string get(const std::string& name) const;  // fails with a clear line where there is none
};

}  // namespace etendue
