// Programs that are made ahead of those who ask for them.
#include <doctest/doctest.h>

#include "host/gpu/program_store.h"
#include "tests/support/device_fixture.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

// The file that holds a kernel of so many additions.
std::filesystem::path make_shader(const std::filesystem::path& folder, const std::string& name, int length) {
    ShaderSources sources;
    std::string& text = sources.generated[name + ".comp"];
    text =
        "layout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer Out { uint o[]; };\nvoid main() "
        "{\n";
    for (int i = 0; i < length; ++i) text += fmt::format("o[{}] += {}u;\n", i, i + 7);
    text += "}\n";
    CompileOptions options;
    options.cache_folder = folder;
    return compile_shader(sources, name + ".comp", options).file;
}

}  // namespace

TEST_CASE("programs that are expected are made ahead, the largest first") {
    TemporaryFolder folder;
    const auto small = make_shader(folder.path, "small", 1), large = make_shader(folder.path, "large", 50);
    ProgramStore store;
    CHECK(store.find(2) == nullptr);
    store.expect(test_device(), {{1, small}, {2, large}});
    const auto program = store.find(2);
    REQUIRE(program);
    CHECK(program->name() == "large");
    CHECK(store.find(2) == program);
    CHECK(store.find(3) == nullptr);
}

TEST_CASE("a program whose file is gone or broken is left to those who ask for it") {
    TemporaryFolder folder;
    const auto broken = make_shader(folder.path, "broken", 1);
    std::filesystem::resize_file(broken, 3);
    ProgramStore store;
    store.expect(test_device(), {{1, folder.path / "gone-0123456789abcdef.spv"}, {2, broken}});
    CHECK(store.find(1) == nullptr);
    CHECK(store.find(2) == nullptr);
}
