#include "host/lights/emission_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace etendue {
namespace {

constexpr int max_texels = 1 << 16;  // looked at for one triangle

const std::array<float, 256>& srgb_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (int i = 0; i < 256; ++i) {
            const double c = i / 255.0;
            t[i] = float(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
        }
        return t;
    }();
    return table;
}

glm::vec3 linear_texel(const ImageDescription& image, size_t i) {
    if (!image.rgba32f.empty())
        return {image.rgba32f[4 * i], image.rgba32f[4 * i + 1], image.rgba32f[4 * i + 2]};
    const auto& table = srgb_table();
    return {table[image.rgba8[4 * i]], table[image.rgba8[4 * i + 1]], table[image.rgba8[4 * i + 2]]};
}

int wrap_texel(int i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    i = (i % period + period) % period;
    return i < size ? i : 2 * size - 1 - i;
}

}  // namespace

EmissionTexture::EmissionTexture(const ImageDescription& image, const TextureUse& use)
    : use_(use),
      width_(int(image.width)),
      height_(int(image.height)),
      lit_(size_t(image.width) * image.height) {
    const auto& bytes = image.rgba8;
    for (size_t i = 0; i < lit_.size(); ++i)
        lit_[i] = bytes.empty() ? glm::dot(linear_texel(image, i), glm::vec3(0.2126f, 0.7152f, 0.0722f)) > 0
                                : (bytes[4 * i] | bytes[4 * i + 1] | bytes[4 * i + 2]) > 0;
}

bool EmissionTexture::is_dark(const glm::vec2 uv0[3], const glm::vec2 uv1[3]) const {
    // Box around the triangle in texels, where texel (x, y) has its centre at (x + 0.5, y + 0.5).
    glm::dvec2 lo(1e30), hi(-1e30);
    for (int i = 0; i < 3; ++i) {
        const glm::vec2 uv = use_.uv_set == 0 ? uv0[i] : uv1[i];
        const glm::dvec2 corner(
            glm::dot(glm::vec2(use_.uv_matrix.x, use_.uv_matrix.y), uv) + use_.uv_offset.x,
            glm::dot(glm::vec2(use_.uv_matrix.z, use_.uv_matrix.w), uv) + use_.uv_offset.y);
        lo = glm::min(lo, corner * glm::dvec2(width_, height_)),
        hi = glm::max(hi, corner * glm::dvec2(width_, height_));
    }
    if (!((hi.x - lo.x + 4) * (hi.y - lo.y + 4) < max_texels) || !(glm::length(lo) < 1e6)) return false;
    const int first = int(std::floor(lo.x - 1)), end = int(std::ceil(hi.x)) + 1;
    for (int y = int(std::floor(lo.y - 1)); y <= int(std::ceil(hi.y)); ++y) {
        const uint8_t* row = &lit_[size_t(wrap_texel(y, height_, use_.wrap_v)) * width_];
        if (first >= 0 && end <= width_) {
            if (std::memchr(row + first, 1, size_t(end - first))) return false;
            continue;
        }
        for (int x = first; x < end; ++x)
            if (row[wrap_texel(x, width_, use_.wrap_u)]) return false;
    }
    return true;
}

}  // namespace etendue
