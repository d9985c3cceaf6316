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
