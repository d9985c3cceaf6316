#include "host/gltf/splines.h"

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace etendue {
namespace {

using glm::dvec4;

struct Axis {
    size_t degree;
    std::vector<double> knots;
    size_t points() const { return knots.size() - degree - 1; }
    double first() const { return knots[degree]; }
    double last() const { return knots[points()]; }
};

std::vector<double> all_numbers(const JsonAt& at) {
    require_array(at);
    std::vector<double> values;
    for (size_t i = 0; i < at->size(); ++i) values.push_back(number_value(element(at, i), -1e9, 1e9));
    return values;
}

Axis read_axis(const JsonAt& degree, const JsonAt& at) {
    Axis axis{size_t(integer_value(degree, 1, 3)), all_numbers(at)};
    const std::vector<double>& knots = axis.knots;
    if (knots.size() < 2 * axis.degree + 2)
        fail_at(at, "has {} knots; allowed for degree {}: at least {}", knots.size(), axis.degree,
                2 * axis.degree + 2);
    for (size_t i = 1; i < knots.size(); ++i) {
        if (knots[i] < knots[i - 1])
            fail_at(element(at, i), "is {:g}, less than the knot before; allowed: knots that do not fall",
                    knots[i]);
        const bool is_within = knots[i] > axis.first() && knots[i] < axis.last();
        if (is_within && i >= axis.degree && knots[i] == knots[i - axis.degree])
            fail_at(element(at, i),
                    "is there more than {} times, where the surface would be torn; "
                    "allowed: as often as the degree",
                    axis.degree);
    }
    if (!(axis.first() < axis.last())) fail_at(at, "has no span; allowed: knots that rise");
    return axis;
}

// Bézier points, as a cubic, of the span of a curve that begins at knot k: its blossom at ends of the span
// (Ramshaw 1989, "Blossoms are polar forms").
std::array<dvec4, 4> span_points(const Axis& axis, size_t k, const std::vector<dvec4>& points) {
    const size_t p = axis.degree;
    std::vector<dvec4> bezier;
    for (size_t end = 0; end <= p; ++end) {
        std::vector<dvec4> d(points.begin() + ptrdiff_t(k - p), points.begin() + ptrdiff_t(k + 1));
        for (size_t r = 1; r <= p; ++r) {
            const double x = r <= end ? axis.knots[k + 1] : axis.knots[k];
            for (size_t i = p; i >= r; --i) {
                const double lo = axis.knots[k - p + i], hi = axis.knots[k + i - r + 1];
                d[i] = ((hi - x) * d[i - 1] + (x - lo) * d[i]) / (hi - lo);
            }
        }
        bezier.push_back(d[p]);
    }
    while (bezier.size() < 4) {  // the same curve, a degree higher
        const double n = double(bezier.size());
        std::vector<dvec4> higher{bezier.front()};
        for (size_t i = 1; i < bezier.size(); ++i)
            higher.push_back(double(i) / n * bezier[i - 1] + (1 - double(i) / n) * bezier[i]);
        higher.push_back(bezier.back());
        bezier = higher;
    }
    return {bezier[0], bezier[1], bezier[2], bezier[3]};
}

std::vector<dvec4> read_points(const JsonAt& at, const Axis& u, const Axis& v) {
    const JsonAt points = member(at, "control_points");
    require_array(points);
    const size_t count = u.points() * v.points();
    if (points->size() != count)
        fail_at(points, "has {} points; allowed by degree and knots: {} rows of {}, {} together",
                points->size(), v.points(), u.points(), count);
    std::vector<double> weights(count, 1);
    if (const auto given = find_array(at, "weights")) {
        if ((*given)->size() != count)
            fail_at(*given, "has {} weights; allowed: one a point, {}", (*given)->size(), count);
        for (size_t i = 0; i < count; ++i) weights[i] = number_value(element(*given, i), 1e-9, 1e9);
    }
    std::vector<dvec4> result;
    for (size_t i = 0; i < count; ++i) {
        const std::vector<double> p = number_array(element(points, i), 3, -1e9, 1e9);
        result.push_back(weights[i] * dvec4(p[0], p[1], p[2], 1));
    }
    return result;
}

}  // namespace

nlohmann::json patches_of_spline(const JsonAt& at) {
    only_members(at, {"class", "material", "degree", "knots", "weights", "control_points"});
    const JsonAt degree = member(at, "degree"), knots = member(at, "knots");
    for (const JsonAt& pair : {degree, knots}) {
        require_array(pair);
        if (pair->size() != 2) fail_at(pair, "has {} elements; allowed: 2, of u and of v", pair->size());
    }
    const Axis u = read_axis(element(degree, 0), element(knots, 0)),
               v = read_axis(element(degree, 1), element(knots, 1));
    const std::vector<dvec4> points = read_points(at, u, v);
    nlohmann::json patches = nlohmann::json::array();
    const auto along = [](const Axis& axis, size_t k) {
        return (axis.knots[k] - axis.first()) / (axis.last() - axis.first());
    };
    for (size_t l = v.degree; l < v.points(); ++l)
        for (size_t k = u.degree; k < u.points(); ++k) {
            if (!(u.knots[k] < u.knots[k + 1]) || !(v.knots[l] < v.knots[l + 1])) continue;
            std::array<std::vector<dvec4>, 4> columns;  // of Bézier points along u, spline points along v
            for (size_t j = 0; j < v.points(); ++j) {
                const auto row = points.begin() + ptrdiff_t(j * u.points());
                const auto cubic = span_points(u, k, {row, row + ptrdiff_t(u.points())});
                for (size_t i = 0; i < 4; ++i) columns[i].push_back(cubic[i]);
            }
            std::array<std::array<dvec4, 4>, 4> net;
            for (size_t i = 0; i < 4; ++i) net[i] = span_points(v, l, columns[i]);
            nlohmann::json list = nlohmann::json::array();
            for (size_t j = 0; j < 4; ++j)
                for (size_t i = 0; i < 4; ++i) {
                    const dvec4& p = net[i][j];
                    list.push_back({p.x / p.w, p.y / p.w, p.z / p.w, p.w});
                }
            patches.push_back(
                {{"points", list}, {"uv", {along(u, k), along(v, l), along(u, k + 1), along(v, l + 1)}}});
        }
    return patches;
}

}  // namespace etendue
