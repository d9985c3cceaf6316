// GLSL to SPIR-V through libglslang, with #include, and a cache on disk keyed by the preprocessed source.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/gpu/shader_source.h"

namespace etendue {

using Spirv = std::vector<uint32_t>;

struct CompiledShader {
    std::string name;  // of the kernel: its file name without folder and ending
    Spirv spirv;
    bool from_cache = false;
    double seconds = 0;          // compile time, 0 from the cache
    std::filesystem::path file;  // of the cache, that holds it; empty = none
};

struct CompileOptions {
    std::string defines;                 // GLSL text put behind the prelude, e.g. "#define HAS_TEXTURES 0\n"
    std::filesystem::path cache_folder;  // empty = no cache
    bool optimize = true;  // SPIRV-Tools performance passes: halves the driver's pipeline creation
};

// Compiles the file `name` of `sources` as a compute shader. Errors: fail_input with the compiler's first
// message, file and line.
CompiledShader compile_shader(const ShaderSources& sources, const std::string& name,
                              const CompileOptions& options = {});

// What such a file holds; nothing where it is gone.
std::optional<CompiledShader> read_cached_shader(const std::filesystem::path& file);

// Removes files of the cache that were not used for the longest time, until it takes three quarters of
// `bytes`, where it takes more than that. A process does so by itself when it adds its first file.
void trim_cache(const std::filesystem::path& folder, uint64_t bytes);

// $XDG_CACHE_HOME/etendue or ~/.cache/etendue; created where needed; empty where neither can be.
std::filesystem::path default_cache_folder();

}  // namespace etendue
