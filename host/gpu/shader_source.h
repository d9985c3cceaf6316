// Where shader text comes from: the copy embedded in the binary, a folder on disk (--shaders), text that the
// host generates for a scene, and class files that a scene brings along.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace etendue {

// Resolves the names that #include directives and kernels use.
struct ShaderSources {
    std::filesystem::path folder;                  // read before the embedded copy when not empty
    std::map<std::string, std::string> generated;  // name -> text, read before everything else

    // Reads the folder as it is now: what is edited later changes nothing.
    void keep_folder();

    std::optional<std::string> find(const std::string& name) const;
    std::string get(const std::string& name) const;  // fails with a clear line where there is none
    // Of all text that stands before the embedded copy; the folder must be kept.
    uint64_t hash() const;
    // The same with the embedded copy; nothing where there is a folder that is not kept.
    std::optional<uint64_t> whole_hash() const;

    struct KeptFolder {
        std::map<std::string, std::string> files;
        uint64_t hash = 0;
    };
    std::shared_ptr<const KeptFolder> kept;
};

// FNV-1a.
uint64_t hash_text(std::string_view text, uint64_t start = 0xcbf29ce484222325ull);

}  // namespace etendue
