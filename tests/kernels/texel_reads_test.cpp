// Reads of storage buffers by way of texel buffers bring the same bits (host/gpu/texel_reads.h).
#include "host/gpu/texel_reads.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>

#include "tests/support/device_fixture.h"

using namespace etendue;

namespace {

// Rows of 48 bytes with vectors across texels, a matrix, an array that is asked by a variable, and a signed number; rows of 20 and of
// 8 bytes; and a block that is written.
const char* const text = R"(
    layout(local_size_x = 64) in;
    struct Part { vec2 at; int sign; };
    struct Wide { float first; vec3 across; Part part; mat2x2 m; uint last; };
    struct Odd { uint numbers[4]; float end; };
    layout(scalar, set = 0) readonly buffer Wides { uint header; uint header_2; uint header_3; uint header_4; Wide wides[]; };
    layout(scalar, set = 0) readonly buffer Odds { Odd odds[]; };
    layout(scalar, set = 0) readonly buffer Pairs { uvec2 pairs[]; };
    layout(scalar, set = 0) readonly buffer Quads { mat4x3 quads[]; };
    layout(scalar, set = 0) buffer Sums { float sums[]; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        Wide w = wides[(i * 7u) % 64u];
        Odd o = odds[(i * 5u) % 64u];
        uvec2 p = pairs[63u - i];
        float sum = w.first + w.across.x + 2.0 * w.across.y + 3.0 * w.across[i % 3u] + w.part.at.y * float(w.part.sign);
        sum += dot(w.m * vec2(1, 2), vec2(3, 5)) + float(w.last) + float(odds[i].numbers[i % 4u]) + float(o.numbers[2]) + o.end;
        sum += dot(quads[(i * 3u) % 64u] * vec4(1, 2, 3, 4), vec3(1, 10, 100));
        sums[i] += sum + float(p.x) - float(p.y);
    }
)";

ShaderSources probe_sources() {
    ShaderSources sources;
    sources.generated["read_texels"] = text;
    return sources;
}

// Floats whose sums are exact, and integers.
std::vector<float> wide_rows() {
    std::vector<float> words(4 + 64 * 12);
    std::iota(words.begin(), words.end(), 0.0f);
    for (size_t row = 0; row < 64; ++row) {
        const int sign = row % 2 ? -1 : 1;
        const uint32_t last = uint32_t(row) * 3;
        std::memcpy(&words[4 + 12 * row + 6], &sign, 4);
        std::memcpy(&words[4 + 12 * row + 11], &last, 4);
    }
    return words;
}

std::vector<float> sums(Device& device) {
    std::vector<uint32_t> odd(64 * 5), pairs(128);
    std::iota(odd.begin(), odd.end(), 1u);
    std::iota(pairs.begin(), pairs.end(), 5u);
    for (size_t row = 0; row < 64; ++row) {
        const float end = float(row) * 0.5f;
        std::memcpy(&odd[5 * row + 4], &end, 4);
    }
    const Buffer wides = create_buffer(device, wide_rows(), "Wides");
    const Buffer odds = create_buffer(device, odd, "Odds");
    const Buffer pair_buffer = create_buffer(device, pairs, "Pairs");
    std::vector<float> quads(64 * 12);
    std::iota(quads.begin(), quads.end(), -100.0f);
    const Buffer quad_buffer = create_buffer(device, quads, "Quads");
    const Buffer result = create_buffer(device, std::vector<float>(64, 1.0f), "Sums");
    const Kernel kernel(device, compile_shader(probe_sources(), "read_texels"),
                        {{"Wides", &wides}, {"Odds", &odds}, {"Pairs", &pair_buffer}, {"Quads", &quad_buffer}, {"Sums", &result}});
    CommandList commands(device);
    commands.dispatch(kernel, 1);
    commands.run();
    return result.read_array<float>(64);
}

std::unique_ptr<Device> device_that_reads(const char* how) {
    setenv("ETENDUE_READS", how, 1);
    const char* selector = std::getenv("ETENDUE_DEVICE");
    auto device = create_device({selector ? selector : "", true, {}});
    unsetenv("ETENDUE_READS");
    return device;
}

}  // namespace

TEST_CASE("texel buffers bring what storage buffers do") {
    const auto by_texel = device_that_reads("texels"), by_address = device_that_reads("addresses");
    REQUIRE(by_texel->description.max_texels > 0);
    REQUIRE(by_address->description.max_texels == 0);
    const std::vector<float> expected = sums(*by_address);
    CHECK(*std::max_element(expected.begin(), expected.end()) > 1000.0f);
    CHECK(sums(*by_texel) == expected);
    CHECK(by_texel->validation_messages.empty());
}

TEST_CASE("blocks that are only read become texel buffers, of as wide texels as their strides allow") {
    const Spirv spirv = compile_shader(probe_sources(), "read_texels").spirv;
    std::map<std::string, std::vector<uint32_t>> words;
    for (const TexelShader::View& view : use_texels(spirv, {}, 100).views) words[view.block].push_back(view.words);
    CHECK(words == std::map<std::string, std::vector<uint32_t>>{{"Wides", {4}}, {"Odds", {1}}, {"Pairs", {2}}, {"Quads", {4}}});
    words.clear();
    for (const TexelShader::View& view : use_texels(spirv, {"Odds"}, 100).views) words[view.block].push_back(view.words);
    CHECK(words == std::map<std::string, std::vector<uint32_t>>{{"Wides", {4}}, {"Pairs", {2}}, {"Quads", {4}}});
    CHECK(use_texels(spirv, {}, 1).views.size() == 1);
    CHECK(use_texels(spirv, {"Wides", "Odds", "Pairs", "Quads"}, 100).spirv == spirv);
}
