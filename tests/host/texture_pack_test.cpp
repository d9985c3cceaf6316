// glTF textureInfo to uses of images, packing, and the host's filtering against values worked out by hand.
#include "host/scene/texture_pack.h"

#include <doctest/doctest.h>

#include <cmath>

#include "host/error.h"

using namespace etendue;
using nlohmann::json;

namespace {

// Two texels, black and white with alpha 0 and 1.
ImageDescription two_texels() {
    return {.name = "two", .width = 2, .height = 1, .rgba8 = {0, 0, 0, 0, 255, 255, 255, 255}};
}

std::string complaint(const json& info) {
    std::vector<TextureDescription> textures(1);
    try {
        parse_texture_info(info, TextureContent::color, textures, "scene.gltf: /materials/0/t");
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

double red(const TextureUse& use, double u, double v = 0.5) {
    return texture_value(two_texels(), use, {u, v}, {0, 0}).x;
}

}  // namespace

TEST_CASE("a textureInfo takes image, wrap and filter from its texture") {
    std::vector<TextureDescription> textures{
        {.image = 3}, {.image = 5, .wrap_u = Wrap::clamp, .wrap_v = Wrap::mirror, .nearest = true}};
    TextureUse use = parse_texture_info({{"index", 1}, {"texCoord", 1}, {"scale", 0.5}}, TextureContent::data,
                                        textures, "t");
    CHECK(use.image == 5);
    CHECK(use.wrap_u == Wrap::clamp);
    CHECK(use.wrap_v == Wrap::mirror);
    CHECK(use.nearest);
    CHECK(use.uv_set == 1);
    CHECK(use.content == TextureContent::data);
    CHECK(use.uv_matrix == glm::vec4(1, 0, 0, 1));
}

TEST_CASE("the texture transform is that of the extension's own example") {
    // "utilizes only the lower left quadrant of the source image, rotated clockwise 90 degrees"
    std::vector<TextureDescription> textures(1);
    json transform = {
        {"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}, {"texCoord", 1}};
    TextureUse use =
        parse_texture_info({{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}},
                           TextureContent::color, textures, "t");
    CHECK(use.uv_set == 1);
    auto moved = [&](float u, float v) {
        return glm::vec2(use.uv_matrix.x * u + use.uv_matrix.y * v,
                         use.uv_matrix.z * u + use.uv_matrix.w * v) +
               use.uv_offset;
    };
    CHECK(glm::length(moved(0, 0) - glm::vec2(0, 1)) < 1e-6f);      // the image's lower left corner
    CHECK(glm::length(moved(1, 1) - glm::vec2(0.5, 0.5)) < 1e-6f);  // its centre
    CHECK(glm::length(moved(1, 0) - glm::vec2(0, 0.5)) < 1e-6f);
}

TEST_CASE("a wrong textureInfo is one line with the pointer of what is wrong") {
    CHECK(complaint(7) ==
          "scene.gltf: /materials/0/t: must be a texture, {\"index\": number of the texture}");
    CHECK(complaint(json::object()) == "scene.gltf: /materials/0/t: has no \"index\" of a texture");
    CHECK(complaint({{"index", 1}}) ==
          "scene.gltf: /materials/0/t/index: 1 is not the index of a texture of the scene");
    CHECK(complaint({{"index", -1}}) != "no error");
    CHECK(complaint({{"index", 0.5}}) != "no error");
    CHECK(complaint({{"index", 0}, {"texCoord", 2}})
              .starts_with("scene.gltf: /materials/0/t/texCoord: 2 is not 0 or 1"));
    auto transform = [](json t) {
        return complaint({{"index", 0}, {"extensions", {{"KHR_texture_transform", t}}}});
    };
    CHECK(transform({{"offset", {1}}}) ==
          "scene.gltf: /materials/0/t/extensions/KHR_texture_transform/offset: [1] is not an array of 2 "
          "numbers");
    CHECK(transform({{"scale", {1, "a"}}}).find("/scale/1: \"a\" is not a finite number") !=
          std::string::npos);
    CHECK(transform({{"rotation", 1e300}}).find("/rotation: 1e+300 is not a finite number") !=
          std::string::npos);
    CHECK(transform(1) != "no error");
    CHECK(complaint({{"index", 0}, {"extensions", 4}}) != "no error");
    CHECK(complaint({{"index", 0}, {"extensions", {{"VENDOR_other", 4}}}}) == "no error");
}

TEST_CASE("texel centres keep their value and halfway between them is the mean") {
    TextureUse data{.content = TextureContent::data};
    CHECK(red(data, 0.25) == 0);
    CHECK(red(data, 0.75) == 1);
    CHECK(red(data, 0.5) == doctest::Approx(0.5));
    CHECK(red(data, 0.375) == doctest::Approx(0.25));
}

TEST_CASE("beyond the edge the image repeats, stays or is mirrored") {
    TextureUse use{.content = TextureContent::data};
    CHECK(red(use, 0.0) == doctest::Approx(0.5));  // between the last texel and the first
    CHECK(red(use, -0.25) == 1);
    CHECK(red(use, 1.25) == 0);
    use.wrap_u = Wrap::clamp;
    CHECK(red(use, 0.0) == 0);
    CHECK(red(use, -9.0) == 0);
    CHECK(red(use, 9.0) == 1);
    use.wrap_u = Wrap::mirror;
    CHECK(red(use, -0.25) == 0);
    CHECK(red(use, -0.75) == 1);
    CHECK(red(use, 1.0) == 1);
    CHECK(red(use, 1.75) == 0);
    use.nearest = true;
    CHECK(red(use, 0.499) == 0);
    CHECK(red(use, 0.501) == 1);
}

TEST_CASE("colors are decoded before they are filtered, alpha is not decoded") {
    ImageDescription gray{.name = "gray", .width = 1, .height = 1, .rgba8 = {188, 10, 255, 128}};
    glm::dvec4 value = texture_value(gray, TextureUse{}, {0.5, 0.5}, {0, 0});
    CHECK(value.x == doctest::Approx(std::pow((188 / 255.0 + 0.055) / 1.055, 2.4)));
    CHECK(value.y == doctest::Approx(10 / 255.0 / 12.92));
    CHECK(value.z == doctest::Approx(1));
    CHECK(value.w == doctest::Approx(128 / 255.0));
    CHECK(red(TextureUse{}, 0.5) == doctest::Approx(0.5));
}

TEST_CASE("an image is packed once, whatever the number of its uses, and an unused one not at all") {
    std::vector<ImageDescription> images{
        two_texels(), two_texels(), {.name = "f", .width = 1, .height = 1, .rgba32f = {1, 2, 3, 4}}};
    std::vector<TextureUse> uses;
    CHECK(texture_index(uses, {.image = 1}) == 0);
    CHECK(texture_index(uses, {.image = 1, .content = TextureContent::data}) == 1);
    CHECK(texture_index(uses, {.image = 1}) == 0);
    CHECK(texture_index(uses, {.image = 2}) == 2);
    PackedTextures packed = pack_textures(images, uses);
    CHECK(packed.texels.size() == 6);
    REQUIRE(packed.textures.size() == 3);
    CHECK(packed.textures[0].first == packed.textures[1].first);
    CHECK(packed.textures[2].first == 2);
    CHECK(packed.formats == 7);
}
