// Bicubic Bézier patches, cut into the pieces that the class `bezier_patch` meets rays with: so small that
// the directions of du and dv keep within cones that do not overlap, which bounds by Bernstein's coefficients
// say.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace etendue {

// weight (x, y, z, 1), [j][i] of the point i along u and j along v.
using HomogeneousNet = std::array<std::array<glm::dvec4, 4>, 4>;

struct HomogeneousPatch {
    HomogeneousNet points;
    glm::dvec4 domain{0, 0, 1, 1};  // u and v where it begins and ends
};

// Twin of struct BezierPiece in shaders/geometry/bezier_patch.glsl; a test compares the layouts.
struct BezierPiece {
    glm::mat4 rows[4];
    glm::mat4 area_density;
    glm::vec3 origin;
    float radius;
    glm::vec3 lo, hi;
    glm::vec3 axis;
    glm::vec3 second_along, second_out;
    float slack;
    glm::vec4 domain;
};

// What a scene gives as `control_points`; `place` for messages.
std::vector<HomogeneousPatch> read_bezier_patches(const nlohmann::json& value, const std::string& place);

// Of one object. At places where a patch folds or du and dv are parallel, pieces end at 1/128 of its sides.
// Fails where a patch has no area.
std::vector<BezierPiece> cut_bezier_patches(const std::vector<HomogeneousPatch>& patches,
                                            const std::string& place);

}  // namespace etendue
