#include "host/scene/texture_pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "host/error.h"

namespace etendue {
namespace {

using nlohmann::json;

// As in shaders/features/textures.glsl.
enum Format : uint32_t { format_data8 = 0, format_srgb8 = 1, format_float = 2 };

uint32_t parse_index(const json& object, const char* key, uint32_t fallback, size_t count,
                     const std::string& where, const char* allowed) {
    if (!object.contains(key)) return fallback;
    const json& value = object[key];
    if (!value.is_number_integer() || value < 0 || value >= count)
        fail_input("{}/{}: {} is not {}", where, key, value.dump(), allowed);
    return value.get<uint32_t>();
}

double parse_number(const json& value, const std::string& where) {
    if (!value.is_number() || !std::isfinite(value.get<float>()))
        fail_input("{}: {} is not a finite number", where, value.dump());
    return value.get<double>();
}

glm::dvec2 parse_pair(const json& object, const char* key, glm::dvec2 fallback, const std::string& where) {
    if (!object.contains(key)) return fallback;
    const json& value = object[key];
    std::string at = where + "/" + key;
    if (!value.is_array() || value.size() != 2)
        fail_input("{}: {} is not an array of 2 numbers", at, value.dump());
    return {parse_number(value[0], at + "/0"), parse_number(value[1], at + "/1")};
}

// KHR_texture_transform: scale first, then a rotation that is counter-clockwise where v runs down, then the
// offset.
void apply_transform(const json& transform, TextureUse& use, const std::string& where) {
    if (!transform.is_object()) fail_input("{}: must be an object", where);
    glm::dvec2 offset = parse_pair(transform, "offset", {0, 0}, where);
    glm::dvec2 scale = parse_pair(transform, "scale", {1, 1}, where);
    double angle =
        transform.contains("rotation") ? parse_number(transform["rotation"], where + "/rotation") : 0;
    double c = std::cos(angle), s = std::sin(angle);
    use.uv_matrix = {c * scale.x, s * scale.y, -s * scale.x, c * scale.y};
    use.uv_offset = offset;
    use.uv_set =
        parse_index(transform, "texCoord", use.uv_set, 2, where, "0 or 1, the texture coordinates there are");
}

Format format_of(const ImageDescription& image, const TextureUse& use) {
    if (!image.rgba32f.empty()) return format_float;
    return use.content == TextureContent::color ? format_srgb8 : format_data8;
}

void append_texels(std::vector<uint32_t>& texels, const ImageDescription& image) {
    for (float value : image.rgba32f) texels.push_back(std::bit_cast<uint32_t>(value));
    for (size_t i = 0; i + 3 < image.rgba8.size(); i += 4) {
        const uint8_t* p = &image.rgba8[i];
        texels.push_back(p[0] | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24);
    }
}

double linear_from_srgb(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

glm::dvec4 texel_value(const ImageDescription& image, const TextureUse& use, uint32_t x, uint32_t y) {
    size_t at = 4 * (size_t(y) * image.width + x);
    if (!image.rgba32f.empty())
        return {image.rgba32f[at], image.rgba32f[at + 1], image.rgba32f[at + 2], image.rgba32f[at + 3]};
    glm::dvec4 value =
        glm::dvec4(image.rgba8[at], image.rgba8[at + 1], image.rgba8[at + 2], image.rgba8[at + 3]) / 255.0;
    if (use.content == TextureContent::data) return value;
    return {linear_from_srgb(value.x), linear_from_srgb(value.y), linear_from_srgb(value.z), value.w};
}

// Texel number `i` of an endless row of wrapped texels.
uint32_t wrap_texel(double i, uint32_t size, Wrap wrap) {
    if (wrap == Wrap::clamp) return uint32_t(std::clamp(i, 0.0, size - 1.0));
    double period = wrap == Wrap::repeat ? size : 2.0 * size;
    double inside = i - period * std::floor(i / period);
    if (inside >= size) inside = period - 1 - inside;
    return uint32_t(std::clamp(inside, 0.0, size - 1.0));
}

}  // namespace

TextureUse parse_texture_info(const json& info, TextureContent content,
                              std::span<const TextureDescription> textures, const std::string& where) {
    if (!info.is_object()) fail_input("{}: must be a texture, {{\"index\": number of the texture}}", where);
    if (!info.contains("index")) fail_input("{}: has no \"index\" of a texture", where);
    uint32_t index =
        parse_index(info, "index", 0, textures.size(), where, "the index of a texture of the scene");
    const TextureDescription& texture = textures[index];
    TextureUse use{.image = texture.image,
                   .wrap_u = texture.wrap_u,
                   .wrap_v = texture.wrap_v,
                   .nearest = texture.nearest,
                   .content = content};
    use.uv_set = parse_index(info, "texCoord", 0, 2, where, "0 or 1, the texture coordinates there are");
    if (info.contains("extensions")) {
        const json& extensions = info["extensions"];
        if (!extensions.is_object()) fail_input("{}/extensions: must be an object", where);
        if (extensions.contains("KHR_texture_transform"))
            apply_transform(extensions["KHR_texture_transform"], use,
                            where + "/extensions/KHR_texture_transform");
    }
    return use;
}

uint32_t texture_index(std::vector<TextureUse>& uses, const TextureUse& use) {
    auto found = std::find(uses.begin(), uses.end(), use);
    if (found == uses.end()) found = uses.insert(uses.end(), use);
    return uint32_t(found - uses.begin());
}

PackedTextures pack_textures(std::span<const ImageDescription> images, std::span<const TextureUse> uses) {
    std::vector<bool> used(images.size(), false);
    uint64_t words = 0;
    for (const TextureUse& use : uses) {
        const ImageDescription& image = images[use.image];
        if (!used[use.image]) words += image.rgba32f.size() + image.rgba8.size() / 4;
        used[use.image] = true;
    }
    if (words > std::numeric_limits<uint32_t>::max())
        fail_input("the textures have {} MiB; at most 16384 MiB can be addressed", words >> 18);

    PackedTextures packed;
    packed.texels.reserve(words);
    std::vector<uint32_t> first(images.size());
    for (size_t i = 0; i < images.size(); ++i) {
        if (!used[i]) continue;
        first[i] = uint32_t(packed.texels.size());
        append_texels(packed.texels, images[i]);
    }
    for (const TextureUse& use : uses) {
        const ImageDescription& image = images[use.image];
        uint32_t format = format_of(image, use);
        packed.formats |= 1u << format;
        uint32_t bits =
            format | uint32_t(use.wrap_u) << 2 | uint32_t(use.wrap_v) << 4 | uint32_t(use.nearest) << 6;
        packed.textures.push_back(
            {first[use.image], image.width, image.height, bits, use.uv_matrix, use.uv_offset, use.uv_set, 0});
    }
    return packed;
}

glm::dvec4 texture_value(const ImageDescription& image, const TextureUse& use, glm::dvec2 uv0,
                         glm::dvec2 uv1) {
    glm::dvec2 set = use.uv_set == 0 ? uv0 : uv1;
    glm::dvec4 m = use.uv_matrix;
    double x = (m.x * set.x + m.y * set.y + use.uv_offset.x) * image.width;
    double y = (m.z * set.x + m.w * set.y + use.uv_offset.y) * image.height;
    auto texel = [&](double i, double j) {
        return texel_value(image, use, wrap_texel(i, image.width, use.wrap_u),
                           wrap_texel(j, image.height, use.wrap_v));
    };
    if (use.nearest) return texel(std::floor(x), std::floor(y));
    double i = std::floor(x - 0.5), j = std::floor(y - 0.5), fx = x - 0.5 - i, fy = y - 0.5 - j;
    return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

}  // namespace etendue
