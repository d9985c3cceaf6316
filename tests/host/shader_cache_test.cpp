// The cache of compiled shaders on disk: what it saves, and what it must not mistake.
#include <doctest/doctest.h>

#include "host/gpu/shader_compiler.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

TEST_CASE("a shader comes from the cache until anything that it includes changes") {
    TemporaryFolder folder;
    ShaderSources sources;
    sources.generated["a.comp"] =
        "layout(local_size_x = 1) in;\n#include \"b.glsl\"\n"
        "layout(set = 0, binding = 0) buffer Out { uint o[]; };\nvoid main() { o[0] = B + C; }\n";
    sources.generated["b.glsl"] = "#define B 1\n";
    CompileOptions options;
    options.cache_folder = folder.path;
    options.defines = "#define C 3\n";
    const auto compile = [&] { return compile_shader(sources, "a.comp", options); };
    const CompiledShader first = compile();
    CHECK_FALSE(first.from_cache);
    CHECK(compile().from_cache);
    CHECK(compile().spirv == first.spirv);
    sources.generated["unrelated.glsl"] = "// not included\n";
    CHECK(compile().from_cache);
    sources.generated["b.glsl"] = "#define B 2\n";
    const CompiledShader second = compile();
    CHECK_FALSE(second.from_cache);
    CHECK(second.spirv != first.spirv);
    CHECK(compile().spirv == second.spirv);
    options.defines = "#define C 4\n";
    CHECK_FALSE(compile().from_cache);
    // What is left of a cache that was cut down is compiled anew.
    for (const auto& entry : std::filesystem::directory_iterator(folder.path))
        if (entry.path().extension() == ".spv") std::filesystem::remove(entry.path());
    options.defines = "#define C 3\n";
    CHECK(compile().spirv == second.spirv);
}

TEST_CASE("a cache that has grown too large loses what was not used for the longest time") {
    TemporaryFolder folder;
    const auto now = std::filesystem::file_time_type::clock::now();
    for (int i = 0; i < 10; ++i) {
        const auto path = folder / (std::to_string(i) + ".spv");
        write_text(path, std::string(10000, 'x'));
        std::filesystem::last_write_time(path, now - std::chrono::hours(i));
    }
    const auto count = [&] { return std::distance(std::filesystem::directory_iterator(folder.path), {}); };
    trim_cache(folder.path, 100000);
    CHECK(count() == 10);
    trim_cache(folder.path, 80000);  // to 60000 bytes
    CHECK(count() == 6);
    for (int i = 0; i < 6; ++i) CHECK(std::filesystem::exists(folder / (std::to_string(i) + ".spv")));
}

TEST_CASE("reading from the cache counts as use") {
    TemporaryFolder folder;
    ShaderSources sources;
    sources.generated["a.comp"] = "layout(local_size_x = 1) in;\nvoid main() {}\n";
    CompileOptions options;
    options.cache_folder = folder.path;
    const auto compile = [&] { return compile_shader(sources, "a.comp", options); };
    compile();
    const auto files = [&] { return std::filesystem::directory_iterator(folder.path); };
    const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(100);
    for (const auto& entry : files()) std::filesystem::last_write_time(entry.path(), old);
    CHECK(compile().from_cache);
    for (const auto& entry : files()) CHECK(entry.last_write_time() > old + std::chrono::hours(1));
}
