// Latitude-longitude environment images: the texels and alias tables that shaders/lights/image.glsl reads.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/scene/description.h"

namespace etendue {

// Mirrors struct EnvironmentMapRef of lights/image.glsl, where the layout of the texels is described.
struct EnvironmentMapRef {
    uint32_t first = 0;  // entry of the buffer EnvironmentTexels
    uint32_t width = 0, height = 0;
    uint32_t alias_bits = 0;
    float integral = 0;  // of luminance over the sphere
};
static_assert(sizeof(EnvironmentMapRef) == 20);

struct EnvironmentMap {
    EnvironmentMapRef ref;           // `first` is 0: add the place of `texels` in the buffer
    std::vector<glm::uvec4> texels;  // floats, as bits
};

// Fails (bad input) with the place of the first texel that is negative, infinite or not a number, for an
// image smaller than 1 x 1 or wider than 65536, and for one too bright for float32. 8-bit images are taken as
// sRGB.
EnvironmentMap build_environment_map(const ImageDescription& image);

// Walker's alias table in Vose's construction: entry i stands for i with probability threshold[i], else for
// alias[i]. Sum of weights 0: uniform.
struct AliasTable {
    std::vector<double> threshold;
    std::vector<uint32_t> alias;
};
AliasTable build_alias_table(std::span<const double> weights);

}  // namespace etendue
