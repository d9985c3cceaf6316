// Spheres and tori as scenes give them to `nurbs_patch`.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

namespace etendue {

// Quarter turns, one a span: a quadratic spline with weights.
struct ArcSpline {
    std::vector<glm::dvec2> points;
    std::vector<double> weights, knots;

    ArcSpline(int quarters, double start) {
        for (int i = 0; i <= 2 * quarters; ++i) {
            const double angle = start + i * std::numbers::pi / 4, reach = i % 2 ? std::sqrt(2.0) : 1;
            points.emplace_back(reach * std::cos(angle), reach * std::sin(angle));
            weights.push_back(i % 2 ? std::sqrt(0.5) : 1);
        }
        knots = {0, 0, 0};
        for (int i = 1; i < quarters; ++i) knots.insert(knots.end(), {double(i), double(i)});
        knots.insert(knots.end(), 3, double(quarters));
    }
};

// An arc (distance from the z axis beyond `away`, height) times `radius`, turned around z: facing outward
// where it runs upward.
inline nlohmann::json nurbs_revolution(const ArcSpline& arc, double away, double radius) {
    const ArcSpline turn(4, 0);
    nlohmann::json spline = {
        {"class", "nurbs_patch"}, {"degree", {2, 2}}, {"knots", {turn.knots, arc.knots}}};
    for (size_t j = 0; j < arc.points.size(); ++j)
        for (size_t i = 0; i < turn.points.size(); ++i) {
            const double reach = radius * arc.points[j].x + away;
            spline["control_points"].push_back(
                {reach * turn.points[i].x, reach * turn.points[i].y, radius * arc.points[j].y});
            spline["weights"].push_back(turn.weights[i] * arc.weights[j]);
        }
    return spline;
}
inline nlohmann::json nurbs_sphere(double radius) {
    return nurbs_revolution(ArcSpline(2, -std::numbers::pi / 2), 0, radius);
}
inline nlohmann::json nurbs_torus(double radius, double tube) {
    return nurbs_revolution(ArcSpline(4, -std::numbers::pi), radius, tube);
}

}  // namespace etendue
