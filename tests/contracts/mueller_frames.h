// Mueller matrices that a probe has asked for, and frames to look at them in.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "tests/support/surface_probe.h"

namespace etendue {

// Rows first; m[0][0] = 1.
inline glm::dmat4 matrix(const MuellerAnswer& a, int lane = 0) {
    glm::dmat4 m;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) m[k][i] = double(a.m[4 * i + k][lane]) / a.m[0][lane];
    return m;
}

// To a frame whose first axis is `axis`, from one where it is x, of light along `direction`.
inline glm::dmat4 rotator(const glm::dvec3& x, const glm::dvec3& axis, const glm::dvec3& direction) {
    const double c = glm::dot(x, axis), s = glm::dot(glm::cross(x, axis), direction), n = c * c + s * s;
    glm::dmat4 m(1);
    m[1][1] = m[2][2] = (c * c - s * s) / n;
    m[2][1] = 2 * s * c / n, m[1][2] = -m[2][1];
    return m;
}

inline glm::dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace etendue
