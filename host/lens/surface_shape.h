// Surfaces of lenses: conics and even aspheres about the z axis, and cylinders of the same sections. In mm,
// double precision.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace etendue {

// z(r) = c r² / (1 + √(1 - (1 + K) c² r²)) + a₁ r² + a₂ r⁴ + …, the sheet that holds the vertex at the
// origin. Its normal points towards +z.
struct SurfaceShape {
    double curvature = 0;              // c, 1/mm; 0 = plane
    double conic = 0;                  // K: 0 sphere, -1 paraboloid, below -1 hyperboloid
    std::vector<double> coefficients;  // a₁, a₂, …: of r², r⁴, …
    bool is_cylinder = false;          // r is |y|: the same for all x

    // Not a number beyond `reach`.
    double sag(double x, double y) const;
    double reach() const;  // mm: the greatest r that the vertex sheet has; infinite where there is none
    double vertex_curvature() const;
    glm::dvec3 normal(const glm::dvec3& point) const;  // of a point on it; unit

    // The t at which the line o + t d (d unit) meets the vertex sheet; of two crossings of a conic that
    // nearer to the axis, of an asphere one near that of its conic. May be negative. None where the line
    // misses it.
    std::optional<double> intersect(const glm::dvec3& o, const glm::dvec3& d) const;

  private:
    double squared_r(const glm::dvec3& p) const { return is_cylinder ? p.y * p.y : p.x * p.x + p.y * p.y; }
    double sag_of(double r2) const;    // of r², continued flat beyond `reach`
    double slope_of(double r2) const;  // dz/d(r²)
    std::optional<double> intersect_conic(const glm::dvec3& o, const glm::dvec3& d) const;
};

}  // namespace etendue
