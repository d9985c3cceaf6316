// How bright the parts of emissive triangles are, where textures or alpha make them differ: trees by which
// shaders/features/emission_maps.glsl samples points of a light in proportion to that.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace etendue {

// A part of a triangle, in barycentric coordinates (b1, b2): the triangle of its corner, the corner + (size, 0) and
// the corner + (0, size). A negative size turns it around. Twin of EmissionCell in kernels/measure_emission.comp.
struct EmissionCell {
    uint32_t primitive = 0;
    float size = 1;
    glm::vec2 corner{0};
};

// What that kernel finds there: luminance over that of the material's emission before textures and alpha.
struct EmissionSample {
    float mean = 0, mean_square = 0;
    float greatest = 0;  // there and a little around it
};

// Mirrors struct EmissionNode of emission_maps.glsl: a cell and its four parts, of half its size; those at its
// corners in their order, then the one between them, which is turned around.
struct EmissionNode {
    glm::vec4 shares{0};             // probabilities of the parts
    glm::uvec4 parts{0xFFFFFFFFu};  // the node of each; 0xFFFFFFFF = even
};
static_assert(sizeof(EmissionNode) == 32);

// Mirrors struct EmissionRoot: of a primitive.
struct EmissionRoot {
    uint32_t node = 0xFFFFFFFFu;  // of the whole triangle; 0xFFFFFFFF = even
    float part = 1;               // mean of what EmissionSample says
};
static_assert(sizeof(EmissionRoot) == 8);

// One that is asked for. `texels`: longest edge, in texels of the finest texture on it; 0 without any, negative for
// shapes, which are never more than even. `weight`: its power if all of it were as bright as can be.
struct EmissionRequest {
    uint32_t primitive = 0;
    double texels = 0, weight = 1;
};

struct EmissionMaps {
    std::vector<EmissionNode> nodes;
    std::vector<EmissionRoot> roots;  // of each request
    struct Lit {
        glm::vec2 lo{0}, hi{1};  // barycentric: all that is not dark lies between
    };
    std::vector<Lit> lit;  // of each request
};

// Looks at all texels, as long as there are no more than some million; then more closely at what differs most, until
// sampling has a relative variance of 0.0004 or 250000 parts are looked at.
EmissionMaps build_emission_maps(
    std::span<const EmissionRequest> requests,
    const std::function<std::vector<EmissionSample>(const std::vector<EmissionCell>&)>& measure);

}  // namespace etendue
