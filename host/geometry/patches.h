// The surfaces of a scene of few primitives, as the unrolled traversal tests them: pairs of triangles that
// make a parallelogram are one.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/scene/description.h"
#include "host/geometry/world.h"

namespace etendue {

// The uv of a hit is affine in the position: u = dot(rows[0], (p, 1)), v = dot(rows[1], (p, 1)).
struct PatchPiece {
    uint32_t primitive = 0;
    glm::dvec4 rows[2] = {glm::dvec4(0), glm::dvec4(0)};
};

struct Patch {
    enum class Kind { triangle, parallelogram, disk, sphere } kind = Kind::triangle;
    glm::dvec3 corner{0}, e1{0}, e2{0};  // m; of a disk and a sphere the centre; of a disk e1, e2 are radii
    double radius = 0;                   // m
    PatchPiece pieces[2];
    bool two = false;
    glm::dvec4 divide = glm::dvec4(0, 0, 0, 1);  // which piece: the first where dot(divide, (p, 1)) >= 0
};

// Gradients of the coordinates a, b in p = a e1 + b e2 within the plane.
std::array<glm::dvec3, 2> dual(const glm::dvec3& e1, const glm::dvec3& e2);

// Infinite where it has none.
double shortest_side(const Patch& patch);

// nullopt where some primitive is no patch: an instance, a shape of another class or oddly scaled, a sliver.
std::optional<std::vector<Patch>> find_patches(const World& world, const SceneDescription& scene);

}  // namespace etendue
