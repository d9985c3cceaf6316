// Image textures for the device: the uses that materials make of images, and all texels they need in one
// array.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/scene/description.h"

namespace etendue {

// What the texels of an 8-bit image mean. Float images are linear in any case.
enum class TextureContent { color, data };  // color: sRGB, alpha linear; data: linear

// An image as one material parameter uses it. KHR_texture_transform is folded into the affine map of uv.
struct TextureUse {
    uint32_t image = 0;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;
    TextureContent content = TextureContent::color;
    glm::vec4 uv_matrix{1, 0, 0, 1};  // rows: u' = dot(xy, uv) + offset.x, v' = dot(zw, uv) + offset.y
    glm::vec2 uv_offset{0, 0};
    uint32_t uv_set = 0;  // 0 or 1

    bool operator==(const TextureUse&) const = default;
};

// A glTF textureInfo: {"index", "texCoord", "extensions": {"KHR_texture_transform": …}}; other members, such
// as the scale of a normal texture, are the caller's. Fails with one line that begins with `where`.
TextureUse parse_texture_info(const nlohmann::json& info, TextureContent content,
                              std::span<const TextureDescription> textures, const std::string& where);

// Index of `use` in `uses`, appended where it is new: the index that a TextureRef holds.
uint32_t texture_index(std::vector<TextureUse>& uses, const TextureUse& use);

// Twin of the struct Texture of shaders/features/textures.glsl, scalar layout.
struct TextureRecord {
    uint32_t first, width, height, format_and_wrap;
    glm::vec4 uv_matrix;
    glm::vec2 uv_offset;
    uint32_t uv_set, padding;
};
static_assert(sizeof(TextureRecord) == 48);

struct PackedTextures {
    std::vector<uint32_t> texels;         // the buffer Texels
    std::vector<TextureRecord> textures;  // the buffer Textures, in the order of the uses
    uint32_t formats = 0;                 // the macro TEXTURE_FORMATS: a bit for each format in use
};

// Every image in use is packed once, whatever the number of its uses.
PackedTextures pack_textures(std::span<const ImageDescription> images, std::span<const TextureUse> uses);

// What texture_value of the shaders gives, in double precision.
glm::dvec4 texture_value(const ImageDescription& image, const TextureUse& use, glm::dvec2 uv0,
                         glm::dvec2 uv1);

}  // namespace etendue
