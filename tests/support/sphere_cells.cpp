#include "tests/support/sphere_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {
namespace {

constexpr double pi = std::numbers::pi;

std::array<double, 2> coordinates(glm::vec3 w) {
    double phi = std::atan2(double(w.z), double(w.y));
    return {double(w.x), phi < 0 ? phi + 2 * pi : phi};
}

// Gauss-Legendre rule of six points on [0, 1].
constexpr std::array<double, 6> nodes = {0.03376524289842397, 0.16939530676686776, 0.38069040695840156,
                                         0.61930959304159844, 0.83060469323313224, 0.96623475710157603};
constexpr std::array<double, 6> weights = {0.08566224618958517, 0.18038078652406930, 0.23395696728634552,
                                           0.23395696728634552, 0.18038078652406930, 0.08566224618958517};

using Integrand = SphereCells::Integrand;

std::vector<glm::dvec4> gauss(const Integrand& integrand, const std::vector<SphereCell>& cells) {
    std::vector<glm::vec3> directions;
    directions.reserve(cells.size() * 36);
    for (const SphereCell& c : cells)
        for (double u : nodes)
            for (double v : nodes) {
                const double t = c.t0 + u * (c.t1 - c.t0), phi = c.phi0 + v * (c.phi1 - c.phi0);
                const double r = std::sqrt((1 - t) * (1 + t));
                directions.push_back(glm::vec3(t, r * std::cos(phi), r * std::sin(phi)));
            }
    const std::vector<glm::vec4> values = integrand(directions);
    std::vector<glm::dvec4> result;
    size_t i = 0;
    for (const SphereCell& c : cells) {
        glm::dvec4 sum(0);
        for (double u : weights)
            for (double v : weights) sum += u * v * glm::dvec4(values[i++]);
        result.push_back(sum * (c.t1 - c.t0) * (c.phi1 - c.phi0));
    }
    return result;
}

}  // namespace

SphereCells::SphereCells(std::span<const glm::vec3> points, size_t draws, size_t least)
    : point_count_(draws) {
    std::vector<Coordinates> above, below;
    for (glm::vec3 w : points) {
        const auto c = coordinates(w);
        (c[1] < pi ? above : below).push_back(c);
    }
    const size_t upper = build(std::move(above), {-1, 1, 0, pi}, 0, least);
    const size_t lower = build(std::move(below), {-1, 1, pi, 2 * pi}, 0, least);
    root_ = nodes_.size();
    nodes_.push_back({1, pi, {upper, lower}});
}

size_t SphereCells::build(std::vector<Coordinates> points, SphereCell cell, int axis, size_t least) {
    if (points.size() < least) {
        cells_.push_back(cell);
        points_.push_back(std::move(points));
        nodes_.push_back({-1, 0, {cells_.size() - 1, 0}});
        return nodes_.size() - 1;
    }
    std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    // Narrow lobes: first cut the empty space off, at a quantile where the lobe is thin.
    const size_t margin = points.size() / 64;
    const double lo = axis == 0 ? cell.t0 : cell.phi0, hi = axis == 0 ? cell.t1 : cell.phi1;
    const double first_point = points[margin][axis], last_point = points[points.size() - 1 - margin][axis];
    size_t cut = points.size() / 2;
    if (last_point - first_point < 0.25 * (hi - lo))
        cut = hi - last_point > first_point - lo ? points.size() - 1 - margin : margin;
    const auto middle = points.begin() + ptrdiff_t(cut);
    const double at = (*middle)[axis];
    SphereCell low = cell, high = cell;
    (axis == 0 ? low.t1 : low.phi1) = at;
    (axis == 0 ? high.t0 : high.phi0) = at;
    std::vector<Coordinates> rest(middle, points.end());
    points.erase(middle, points.end());
    const size_t first = build(std::move(points), low, 1 - axis, least);
    const size_t second = build(std::move(rest), high, 1 - axis, least);
    nodes_.push_back({axis, at, {first, second}});
    return nodes_.size() - 1;
}

size_t SphereCells::find(glm::vec3 direction) const {
    const auto c = coordinates(direction);
    size_t node = root_;
    while (nodes_[node].axis >= 0)
        node = nodes_[node].children[c[nodes_[node].axis] < nodes_[node].at ? 0 : 1];
    return nodes_[node].children[0];
}

std::vector<glm::dvec4> SphereCells::integrate(const Integrand& integrand, double tolerance) const {
    struct Part {
        SphereCell cell;
        size_t owner;
        glm::dvec4 coarse;
        std::vector<Coordinates> points;
    };
    std::vector<glm::dvec4> result(size(), glm::dvec4(0));
    std::vector<Part> active(size());
    const std::vector<glm::dvec4> coarse = gauss(integrand, cells_);
    for (size_t i = 0; i < size(); ++i) active[i] = {cells_[i], i, coarse[i], points_[i]};
    for (int depth = 0; !active.empty(); ++depth) {
        std::vector<SphereCell> children;
        for (const Part& p : active) {
            const SphereCell& c = p.cell;
            const double t = 0.5 * (c.t0 + c.t1), phi = 0.5 * (c.phi0 + c.phi1);
            children.push_back({c.t0, t, c.phi0, phi});
            children.push_back({c.t0, t, phi, c.phi1});
            children.push_back({t, c.t1, c.phi0, phi});
            children.push_back({t, c.t1, phi, c.phi1});
        }
        const std::vector<glm::dvec4> fine = gauss(integrand, children);
        std::vector<Part> next;
        const bool last = depth >= 16 || active.size() > 20000;
        for (size_t i = 0; i < active.size(); ++i) {
            const Part& p = active[i];
            const glm::dvec4 sum = fine[4 * i] + fine[4 * i + 1] + fine[4 * i + 2] + fine[4 * i + 3];
            const glm::dvec4 d = glm::abs(sum - p.coarse);
            const bool settled = std::max({d.x, d.y, d.z, d.w}) <= tolerance;
            const double found = sum.w * double(point_count_), there = double(p.points.size());
            const bool missed =
                found < 0.1 * there || (depth < 3 && std::abs(found - there) > 2.5 * std::sqrt(there));
            if (last || (settled && !missed)) {
                result[p.owner] += sum;
                continue;
            }
            for (size_t k = 4 * i; k < 4 * i + 4; ++k) {
                Part child{children[k], p.owner, fine[k], {}};
                for (const Coordinates& point : p.points)
                    if (point[0] >= child.cell.t0 && point[0] < child.cell.t1 &&
                        point[1] >= child.cell.phi0 && point[1] < child.cell.phi1)
                        child.points.push_back(point);
                next.push_back(std::move(child));
            }
        }
        active = std::move(next);
    }
    return result;
}

}  // namespace etendue
