#include "host/gpu/shader_compiler.h"

#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <set>
#include <spirv-tools/optimizer.hpp>

#include "host/error.h"

namespace etendue {
namespace {

// Stands in front of every kernel; class files and kernels carry no boilerplate.
const char* const prelude = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_EXT_buffer_reference : enable
#extension GL_EXT_buffer_reference_uvec2 : enable
)";

// All names are relative to the shader root, so the includer of a file plays no part. A file is included
// once: a second #include of it is empty, so that every file names what it needs.
class Includer : public glslang::TShader::Includer {
  public:
    explicit Includer(const ShaderSources& sources) : sources_(sources) {}

    IncludeResult* includeLocal(const char* name, const char*, size_t) override {
        auto text = sources_.find(name);
        if (!text) return nullptr;
        if (!included_.insert(name).second) text->clear();
        auto* owned = new std::string(std::move(*text));
        return new IncludeResult(name, owned->data(), owned->size(), owned);
    }
    void releaseInclude(IncludeResult* result) override {
        if (!result) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

  private:
    const ShaderSources& sources_;
    std::set<std::string> included_;
};

// glslang's log starts with "ERROR: FILE:LINE: message"; the first such line is what a user needs.
std::string first_error(const char* log) {
    std::string_view text = log;
    size_t start = text.find("ERROR: ");
    if (start == std::string_view::npos) return std::string(text);
    text.remove_prefix(start + 7);
    text = text.substr(0, text.find('\n'));
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return std::string(text);
}

// Of SPIR-V as glslang writes it. Kernels that are within the budget of the schedules' (kernel_size_test.cpp)
// have at most 460 kB then; on one of 930 the optimiser takes a minute, follows values through blocks by
// recursion, and overflows the stack. Larger ones stay as they are.
constexpr uint64_t most_optimized_bytes = 640 << 10;

constexpr uint64_t most_cache_bytes = 512 << 20;
constexpr uint64_t file_bytes = 4096;  // that a file takes at least

// For trim_cache.
void note_use(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now(), error);
}

bool read_spirv(const std::filesystem::path& path, Spirv& spirv) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return false;
    const auto bytes = size_t(file.tellg());
    if (bytes < 20 || bytes % 4) return false;
    spirv.resize(bytes / 4);
    file.seekg(0);
    file.read(reinterpret_cast<char*>(spirv.data()), std::streamsize(bytes));
    note_use(path);
    return file.good() && spirv[0] == 0x07230203u;
}

// Written beside its place and renamed, so that a reader never sees half a file. A full disk only costs the
// cache.
void write_cached(const std::filesystem::path& path, const void* data, size_t bytes) {
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}", ::getpid());
    std::ofstream file(temporary, std::ios::binary);
    file.write(static_cast<const char*>(data), std::streamsize(bytes));
    file.close();
    std::error_code error;
    if (file)
        std::filesystem::rename(temporary, path, error);
    else
        std::filesystem::remove(temporary, error);
    static std::once_flag once;
    std::call_once(once, [&] { trim_cache(path.parent_path(), most_cache_bytes); });
}

// Of the same kernel by its preprocessed source.
std::filesystem::path cached_spirv(const CompileOptions& options, const std::string& kernel, uint64_t hash) {
    return options.cache_folder / fmt::format("{}-{:016x}.spv", kernel, hash);
}

// The hash of the preprocessed source of text that was compiled before: preprocessing it again takes glslang
// longer than all else of a start.
bool read_hash(const std::filesystem::path& path, uint64_t& hash) {
    std::ifstream file(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(&hash), sizeof hash)) return false;
    note_use(path);
    return true;
}

void optimize(Spirv& spirv) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
    optimizer.RegisterPerformancePasses();
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    Spirv optimized;
    if (optimizer.Run(spirv.data(), spirv.size(), &optimized, options)) spirv = std::move(optimized);
}

struct GlslangProcess {
    GlslangProcess() { glslang::InitializeProcess(); }
    ~GlslangProcess() { glslang::FinalizeProcess(); }
};

}  // namespace

CompiledShader compile_shader(const ShaderSources& sources, const std::string& name,
                              const CompileOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    CompiledShader result;
    result.name = std::filesystem::path(name).stem().string();
    const uint64_t version = hash_text(ETENDUE_VERSION, options.optimize ? 1 : 2);

    std::filesystem::path known;  // holds the hash of the preprocessed source
    if (const auto whole = options.cache_folder.empty() ? std::nullopt : sources.whole_hash()) {
        const uint64_t key =
            hash_text(name, hash_text(options.defines, hash_text(prelude, version ^ *whole)));
        known = options.cache_folder / fmt::format("{}-{:016x}.key", result.name, key);
        uint64_t hash = 0;
        if (read_hash(known, hash) && read_spirv(cached_spirv(options, result.name, hash), result.spirv)) {
            result.file = cached_spirv(options, result.name, hash);
            result.from_cache = true;
            return result;
        }
    }

    static GlslangProcess process;
    const std::string text = prelude + options.defines + "#line 1\n" + sources.get(name);
    const char* text_pointer = text.c_str();
    const int text_length = int(text.size());
    const char* text_name = name.c_str();
    auto set_up = [&](glslang::TShader& shader) {
        shader.setStringsWithLengthsAndNames(&text_pointer, &text_length, &text_name, 1);
        shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
        shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
        shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
        shader.setAutoMapBindings(true);
    };
    const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    const TBuiltInResource* limits = GetDefaultResources();

    if (!options.cache_folder.empty()) {
        glslang::TShader shader(EShLangCompute);
        set_up(shader);
        std::string preprocessed;
        Includer includer(sources);
        if (!shader.preprocess(limits, 460, ECoreProfile, false, false, messages, &preprocessed, includer))
            fail_input("{}", first_error(shader.getInfoLog()));
        const uint64_t hash = hash_text(preprocessed, version);
        result.file = cached_spirv(options, result.name, hash);
        if (!known.empty()) write_cached(known, &hash, sizeof hash);
        if (read_spirv(result.file, result.spirv)) {
            result.from_cache = true;
            return result;
        }
    }

    glslang::TShader shader(EShLangCompute);
    set_up(shader);
    Includer includer(sources);
    if (!shader.parse(limits, 460, false, messages, includer))
        fail_input("{}", first_error(shader.getInfoLog()));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages) || !program.mapIO()) fail_input("{}", first_error(program.getInfoLog()));
    glslang::SpvOptions spv_options;
    spv_options.disableOptimizer = true;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), result.spirv, &spv_options);
    if (options.optimize && result.spirv.size() * 4 <= most_optimized_bytes) optimize(result.spirv);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!result.file.empty()) write_cached(result.file, result.spirv.data(), result.spirv.size() * 4);
    return result;
}

std::optional<CompiledShader> read_cached_shader(const std::filesystem::path& file) {
    CompiledShader shader;
    const std::string stem = file.stem().string();  // the kernel's name, and a hash
    shader.name = stem.substr(0, stem.rfind('-'));
    shader.file = file;
    shader.from_cache = true;
    if (!read_spirv(file, shader.spirv)) return std::nullopt;
    return shader;
}

void trim_cache(const std::filesystem::path& folder, uint64_t bytes) {
    struct Used {
        std::filesystem::file_time_type time;
        uint64_t bytes;
        std::filesystem::path path;
    };
    std::vector<Used> files;
    uint64_t total = 0;
    std::error_code error;
    for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
        std::error_code gone;  // another process may trim, too
        const Used file{i->last_write_time(gone), std::max(file_bytes, uint64_t(i->file_size(gone))),
                        i->path()};
        if (gone) continue;
        files.push_back(file);
        total += file.bytes;
    }
    if (total <= bytes) return;
    std::sort(files.begin(), files.end(), [](const Used& a, const Used& b) { return a.time < b.time; });
    for (size_t i = 0; i < files.size() && total > bytes / 4 * 3; ++i) {
        std::filesystem::remove(files[i].path, error);
        total -= files[i].bytes;
    }
}

std::filesystem::path default_cache_folder() {
    std::filesystem::path folder;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
        folder = xdg;
    else if (const char* home = std::getenv("HOME"); home && *home)
        folder = std::filesystem::path(home) / ".cache";
    else
        return {};
    folder = folder / "etendue" / "kernels";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    return error ? std::filesystem::path() : folder;
}

}  // namespace etendue
