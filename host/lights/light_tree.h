// The hierarchy over finite lights that shaders/features/light_selection.glsl descends.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace etendue {

// What kernels/measure_lights.comp finds out about a light. World space.
struct LightBounds {
    glm::vec3 lo{0};          // m; lo > hi for a light at infinity
    float power = 0;          // lm
    glm::vec3 hi{0};          // m
    float cos_normals = -1;   // see LightCone in shaders/interfaces/light_source.glsl
    glm::vec3 axis{0, 0, 1};  // unit
    float cos_emission = 0;
};
static_assert(sizeof(LightBounds) == 48);

bool is_at_infinity(const LightBounds& light);
// Forward rays alone bring its light: unmet_rays() of shaders/interfaces/light_source.glsl.
bool is_unmet(const LightBounds& light);

// Four sets of lights; mirrors struct LightNode of light_selection.glsl.
struct LightNode {
    glm::vec4 x{0}, y{0}, z{0}, radius{0}, intensity{0};
    glm::uvec4 axes{0}, cosines{0}, children{0xFFFFFFFFu};
};
static_assert(sizeof(LightNode) == 128);

// Contents of the buffers LightNodes and LightTrails.
struct LightTree {
    std::vector<LightNode> nodes;
    std::vector<uint32_t> trails;  // one a light, those at infinity included
    bool is_tree = false;          // HAS_LIGHT_TREE; otherwise `nodes` is a list
    uint32_t infinite_count = 0;   // INFINITE_LIGHT_COUNT
    uint32_t depth = 0;            // levels of nodes
};

// Up to this many finite lights are compared one by one rather than by a tree.
constexpr uint32_t max_listed_lights = 16;

// `lights` in the order of the buffer Lights: those at infinity first. The same input gives the same tree. At
// most 2^28 lights; at most 16 levels.
LightTree build_light_tree(std::span<const LightBounds> lights, uint32_t max_listed = max_listed_lights);

// Greatest luminous intensity of a light, cd: its power over the solid angle integral of cos(max(0, angle -
// n)).
float peak_intensity(const LightBounds& light);

}  // namespace etendue
