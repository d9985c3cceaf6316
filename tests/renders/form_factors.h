// Irradiance that emitting shapes of radiance 1 send to a point, in closed form. Double precision.
#pragma once
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace etendue {

// E = pi r² cos / d²: a sphere wholly above the horizon. `direction` from the point to the centre, in metres.
inline double sphere_irradiance(double radius, const glm::dvec3& to_center, const glm::dvec3& normal) {
    const double d = glm::length(to_center);
    return std::numbers::pi * radius * radius / (d * d) * glm::dot(to_center, normal) / d;
}

// A disk parallel to the receiving plane, at height h and a distance a beside the point (Howell,
// configuration B-13).
inline double disk_irradiance(double radius, double h, double a) {
    const double s = h * h + a * a + radius * radius;
    return 0.5 * std::numbers::pi *
           (1 - (h * h + a * a - radius * radius) / std::sqrt(s * s - 4 * a * a * radius * radius));
}

// A polygon wholly above the horizon, its corners relative to the point, counter-clockwise as seen from it or
// not (Lambert 1760): half the sum over the edges of the angle that each fills, times the normal of its
// plane.
inline double polygon_irradiance(const std::vector<glm::dvec3>& corners, const glm::dvec3& normal) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::normalize(corners[i]),
                         b = glm::normalize(corners[(i + 1) % corners.size()]);
        const glm::dvec3 across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, normal);
    }
    return 0.5 * std::fabs(sum);
}

// Any convex surface of which the point sees what faces it: midpoint rule over two parameters in [0,1]².
struct SurfaceElement {
    glm::dvec3 position, normal;
    double area;  // m² for the whole parameter square
};
inline double quadrature_irradiance(const std::function<SurfaceElement(double, double)>& surface,
                                    const glm::dvec3& point, const glm::dvec3& normal, int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const SurfaceElement e = surface((i + 0.5) / steps, (j + 0.5) / steps);
            const glm::dvec3 w = e.position - point;
            const double d2 = glm::dot(w, w);
            sum += std::max(0.0, glm::dot(w, normal)) * std::max(0.0, -glm::dot(w, e.normal)) / (d2 * d2) *
                   e.area;
        }
    return sum / (double(steps) * steps);
}

}  // namespace etendue
