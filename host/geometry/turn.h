// The part of a linear map that turns.
#pragma once
#include <glm/glm.hpp>

namespace etendue {

// m = turn * rest, where rest has no part below its diagonal: scale along it, of which x may be negative, and
// shear above.
struct Parts {
    glm::dmat3 turn, rest;
};
inline Parts parted(const glm::dmat3& m) {
    glm::dvec3 x = glm::normalize(m[0]);
    if (glm::determinant(m) < 0) x = -x;
    const glm::dvec3 y = glm::normalize(m[1] - x * glm::dot(x, m[1]));
    const glm::dmat3 turn(x, y, glm::cross(x, y));
    return {turn, glm::transpose(turn) * m};
}

}  // namespace etendue
