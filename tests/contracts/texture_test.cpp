// texture_value of the shaders against the host's double-precision one, over formats, wraps, filters and
// transforms.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "host/scene/texture_pack.h"
#include "tests/support/device_fixture.h"

using namespace etendue;

namespace {

struct Query {
    uint32_t texture;
    glm::vec2 uv0, uv1;
};

const char* probe = R"(
    #include "lib/records.glsl"
    #include "features/textures.glsl"
    layout(local_size_x = 64) in;
    struct Query { uint texture; vec2 uv0, uv1; };
    layout(scalar, set = 0) readonly buffer Queries { Query queries[]; };
    layout(scalar, set = 0) buffer Results { vec4 results[]; };
    layout(push_constant) uniform Push { uint count; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        Query q = queries[i];
        results[i] = texture_value(TextureRef(q.texture), q.uv0, q.uv1);
    }
)";

std::vector<ImageDescription> make_images(std::mt19937& random) {
    std::uniform_int_distribution<int> byte(0, 255);
    ImageDescription bytes{.name = "bytes", .width = 7, .height = 5};
    for (uint32_t i = 0; i < 7 * 5 * 4; ++i) bytes.rgba8.push_back(uint8_t(byte(random)));
    ImageDescription levels{.name = "every level", .width = 256, .height = 1};
    for (int i = 0; i < 256; ++i)
        for (int c = 0; c < 4; ++c) levels.rgba8.push_back(uint8_t(i));
    ImageDescription single{.name = "single", .width = 1, .height = 1, .rgba8 = {255, 128, 0, 77}};
    ImageDescription floats{.name = "floats", .width = 4, .height = 3};
    for (uint32_t i = 0; i < 4 * 3 * 4; ++i)
        floats.rgba32f.push_back(std::exp(float(byte(random)) * 0.05f - 4.0f));
    return {bytes, levels, single, floats};
}

// Every image with every wrap, content and filter, half of them transformed.
std::vector<TextureUse> make_uses() {
    std::vector<TextureUse> uses;
    for (uint32_t image = 0; image < 4; ++image)
        for (Wrap wrap_u : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
            for (Wrap wrap_v : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
                for (TextureContent content : {TextureContent::color, TextureContent::data})
                    for (bool nearest : {false, true}) {
                        TextureUse use{image, wrap_u, wrap_v, nearest, content};
                        if (uses.size() % 2)
                            use.uv_matrix = {1.25f, 0.75f, -0.5f, 2.0f}, use.uv_offset = {0.125f, -3.5f};
                        use.uv_set = uses.size() / 2 % 2;
                        uses.push_back(use);
                    }
    return uses;
}

struct Probe {
    PackedTextures packed;
    std::vector<glm::vec4> results;
    ShaderLayout layout;
};

Probe run_probe(std::span<const ImageDescription> images, std::span<const TextureUse> uses,
                const std::vector<Query>& queries) {
    Device& device = test_device();
    Probe result{.packed = pack_textures(images, uses)};
    Buffer texels = create_buffer(device, result.packed.texels, "texels");
    Buffer textures = create_buffer(device, result.packed.textures, "textures");
    Buffer query_buffer = create_buffer(device, queries, "queries");
    Buffer results(device, queries.size() * sizeof(glm::vec4), "results");
    std::string text =
        fmt::format("#define HAS_TEXTURES 1\n#define TEXTURE_FORMATS {}\n{}", result.packed.formats, probe);
    const Kernel kernel = make_test_kernel(
        "sample_textures", text,
        {{"Texels", &texels}, {"Textures", &textures}, {"Queries", &query_buffer}, {"Results", &results}});
    result.layout = kernel.layout();
    CommandList list(device);
    list.dispatch(kernel, uint32_t(queries.size() + 63) / 64, {{"count", uint32_t(queries.size())}});
    list.run();
    result.results = results.read_array<glm::vec4>(queries.size());
    return result;
}

}  // namespace

TEST_CASE("textures are filtered on the device as in double precision on the host") {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> coordinate(-2.5f, 3.5f);
    auto images = make_images(random);
    auto uses = make_uses();
    std::vector<Query> queries;
    for (uint32_t i = 0; i < 20000; ++i)
        queries.push_back({i % uint32_t(uses.size()),
                           {coordinate(random), coordinate(random)},
                           {coordinate(random), coordinate(random)}});
    auto results = run_probe(images, uses, queries).results;
    int beside_an_edge = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const Query& q = queries[i];
        const TextureUse& use = uses[q.texture];
        glm::dvec4 expected = texture_value(images[use.image], use, q.uv0, q.uv1);
        glm::dvec4 difference = glm::abs(glm::dvec4(results[i]) - expected);
        // Coordinates carry a rounding of about 1e-6, which moves the weights by that times the size in
        // texels, and may take a nearest lookup to the other side of an edge between texels.
        double tolerance = 1e-5 + 3e-6 * images[use.image].width;
        if (!images[use.image].rgba32f.empty()) tolerance *= 1e4;
        double worst = std::max({difference.x, difference.y, difference.z, difference.w});
        if (use.nearest && worst > tolerance)
            ++beside_an_edge;
        else
            CHECK_MESSAGE(worst <= tolerance, "query ", i, " of texture ", q.texture);
    }
    CHECK(beside_an_edge <= 3);
}

TEST_CASE("every level of an sRGB image is decoded to 3e-6 of its value, and white is one") {
    std::mt19937 random(7);
    auto images = make_images(random);
    std::vector<TextureUse> uses{{.image = 1, .nearest = true}};
    std::vector<Query> queries;
    for (int i = 0; i < 256; ++i) queries.push_back({0, {(float(i) + 0.5f) / 256.0f, 0.5f}, {0, 0}});
    auto probe = run_probe(images, uses, queries);
    CHECK(probe.packed.formats == 2);
    for (int i = 0; i < 256; ++i) {
        double expected = texture_value(images[1], uses[0], queries[size_t(i)].uv0, {0, 0}).x;
        CHECK(std::abs(probe.results[size_t(i)].x - expected) <= 3e-6 * expected);
        CHECK(std::abs(probe.results[size_t(i)].w - i / 255.0) <= 1e-7);
    }
    CHECK(probe.results[255].x == doctest::Approx(1).epsilon(5e-7));
}

TEST_CASE("without a texture the value is one, and coordinates far away stay inside the image") {
    std::mt19937 random(7);
    auto images = make_images(random);
    auto uses = make_uses();
    std::vector<Query> queries{{0xFFFFFFFFu, {0.5f, 0.5f}, {0.5f, 0.5f}}};
    for (uint32_t t = 0; t < uses.size(); ++t)
        for (float far : {-3e38f, -1e9f, -1e-30f, 1.0f, 1e9f, 1e30f})
            queries.push_back({t, {far, far}, {far, far}});
    auto results = run_probe(images, uses, queries).results;
    CHECK(results[0] == glm::vec4(1));
    for (size_t i = 1; i < queries.size(); ++i) {
        float most = images[uses[queries[i].texture].image].rgba32f.empty() ? 1.0f : 1e6f;
        for (int c = 0; c < 4; ++c) CHECK((results[i][c] >= 0 && results[i][c] <= most));
    }
}

TEST_CASE("the host's texture record is laid out as the shader's") {
    std::mt19937 random(7);
    auto images = make_images(random);
    std::vector<TextureUse> uses{{.image = 0}};
    auto probe = run_probe(images, uses, {{0, {0, 0}, {0, 0}}});
    for (const BlockLayout& block : probe.layout.blocks) {
        if (block.name != "Textures") continue;
        CHECK(block.stride == sizeof(TextureRecord));
        std::map<std::string, uint32_t> offsets;
        for (const MemberLayout& member : block.element_members) offsets[member.name] = member.offset;
        CHECK(offsets.at("first") == offsetof(TextureRecord, first));
        CHECK(offsets.at("height") == offsetof(TextureRecord, height));
        CHECK(offsets.at("format_and_wrap") == offsetof(TextureRecord, format_and_wrap));
        CHECK(offsets.at("uv_matrix") == offsetof(TextureRecord, uv_matrix));
        CHECK(offsets.at("uv_offset") == offsetof(TextureRecord, uv_offset));
        CHECK(offsets.at("uv_set") == offsetof(TextureRecord, uv_set));
        return;
    }
    FAIL("the kernel has no buffer Textures");
}
