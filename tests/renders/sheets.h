// Sheets of polarization optics, and where rectangles face.
#pragma once
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "tests/support/render_probe.h"

namespace etendue {

inline nlohmann::json polarizer(double axis) { return {{"class", "linear_polarizer"}, {"axis", axis}}; }
inline nlohmann::json wave_plate(double axis, double retardance) {
    return {{"class", "retarder"}, {"axis", axis}, {"retardance", retardance}};
}

// A rectangle's +z axis towards n, its x axis as near to `x` as may be.
inline Place facing(const glm::dvec3& position, const glm::dvec3& n, const glm::dvec3& x) {
    const glm::dvec3 z = glm::normalize(n), y = glm::normalize(glm::cross(z, x));
    const glm::dquat q = glm::quat_cast(glm::dmat3(glm::cross(y, z), y, z));
    return {position, {q.x, q.y, q.z, q.w}};
}

}  // namespace etendue
