// A partition of the sphere of directions, fine where given points are dense, and integrals over its cells.
//
// Coordinates (t, phi) with direction (t, r cos phi, r sin phi), r² = 1 - t²: area is dt dphi, the horizon z
// = 0 is the border phi = pi of cells, and directions near z and -z keep all their digits.
#pragma once
#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace etendue {

struct SphereCell {
    double t0, t1, phi0, phi1;
    bool above() const { return phi0 < 3.14159265; }  // z > 0
};

class SphereCells {
  public:
    // Cuts cells at the median of their points, or beside the points where these fill little of a cell, until
    // fewer than `least` are left in one. `draws` is how often the points were drawn: those drawn and not
    // given fell on no direction.
    SphereCells(std::span<const glm::vec3> points, size_t draws, size_t least);
    size_t size() const { return cells_.size(); }
    const SphereCell& operator[](size_t i) const { return cells_[i]; }
    size_t find(glm::vec3 direction) const;

    // Integrals of four functions at once over every cell, by Gauss rules that are refined where halving the
    // cells both ways changes the result by more than `tolerance`, or where the fourth, the density of the
    // points, has missed points that are there.
    using Integrand = std::function<std::vector<glm::vec4>(std::span<const glm::vec3> directions)>;
    std::vector<glm::dvec4> integrate(const Integrand& integrand, double tolerance) const;

  private:
    struct Node {
        int axis = -1;  // 0: t, 1: phi, -1: a cell
        double at = 0;
        size_t children[2] = {0, 0};  // or [0] the cell
    };
    using Coordinates = std::array<double, 2>;
    size_t build(std::vector<Coordinates> points, SphereCell cell, int axis, size_t least);
    std::vector<SphereCell> cells_;
    std::vector<std::vector<Coordinates>> points_;  // of each cell
    size_t point_count_;
    std::vector<Node> nodes_;
    size_t root_ = 0;
};

}  // namespace etendue
