// How bright an emissive texture is over parts of a surface: so that triangles it leaves dark are no lights.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/texture_pack.h"

namespace etendue {

class EmissionTexture {
  public:
    EmissionTexture(const ImageDescription& image, const TextureUse& use);

    // Whether every texel that filtering can reach from a triangle, given by its texture coordinates, is
    // black. Triangles that cover more than 65536 texels count as not dark.
    bool is_dark(const glm::vec2 uv0[3], const glm::vec2 uv1[3]) const;

  private:
    TextureUse use_;
    int width_, height_;
    std::vector<uint8_t> lit_;  // 1 where a texel is not black
};

}  // namespace etendue
