// Splines of a scene file: the patches that they become, and what is refused.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/host/gltf_scene_builder.h"
#include "tests/support/nurbs_shapes.h"

using namespace etendue;
using nlohmann::json;

namespace {

GltfBuilder with_geometry(const json& geometry) {
    GltfBuilder b;
    b.node({{"name", "sail"}, {"extensions", {{"ETD_optics", {{"geometry", geometry}}}}}});
    return b;
}

// A cubic of 7 points along u, whose inner knots along u are uneven and not those of the ends.
json sail() {
    json spline = {{"class", "nurbs_patch"},
                   {"degree", {3, 1}},
                   {"knots", {{-1, -0.5, 0, 0.5, 1.25, 2, 2, 3, 3.5, 4, 5}, {0, 0, 1, 3, 3}}}};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 7; ++i) {
            spline["control_points"].push_back({i, j, std::sin(i + 2.0 * j)});
            spline["weights"].push_back(1 + 0.2 * i * j);
        }
    return spline;
}

glm::dvec3 place(const json& points, double u, double v) {
    const auto basis = [](double x, int i) {
        return std::pow(x, i) * std::pow(1 - x, 3 - i) * (i % 3 == 0 ? 1 : 3);
    };
    glm::dvec4 h(0);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const json& p = points[size_t(4 * j + i)];
            const double w = p[3];
            h += basis(u, i) * basis(v, j) * w * glm::dvec4(p[0], p[1], p[2], 1);
        }
    return glm::dvec3(h) / h.w;
}

// By the recursion of the spline's basis (Cox and de Boor).
double basis(const std::vector<double>& knots, size_t i, size_t degree, double x) {
    if (degree == 0) return x >= knots[i] && x < knots[i + 1];
    const double before = knots[i + degree] - knots[i], behind = knots[i + degree + 1] - knots[i + 1];
    return (before > 0 ? (x - knots[i]) / before * basis(knots, i, degree - 1, x) : 0) +
           (behind > 0 ? (knots[i + degree + 1] - x) / behind * basis(knots, i + 1, degree - 1, x) : 0);
}
glm::dvec3 spline_place(const json& s, double x, double y) {
    const std::vector<double> u = s["knots"][0], v = s["knots"][1];
    const size_t p = s["degree"][0], q = s["degree"][1], row = u.size() - p - 1;
    glm::dvec4 h(0);
    for (size_t j = 0; j < v.size() - q - 1; ++j)
        for (size_t i = 0; i < row; ++i) {
            const json& c = s["control_points"][j * row + i];
            const double w = s["weights"][j * row + i];
            h += basis(u, i, p, x) * basis(v, j, q, y) * w * glm::dvec4(c[0], c[1], c[2], 1);
        }
    return glm::dvec3(h) / h.w;
}

}  // namespace

TEST_CASE("a spline becomes patches of the same surface, with its u and v") {
    const json spline = sail();
    const SceneDescription scene = with_geometry(spline).import();
    REQUIRE(scene.shapes.size() == 1);
    CHECK(scene.shapes[0].object.class_name == "bezier_patch");
    const json& patches = scene.shapes[0].object.parameters["control_points"];
    CHECK(patches.size() == 3 * 2);  // of its spans 0.5, 1.25, 2 and 0, 1, 3
    for (const json& patch : patches) {
        const std::vector<double> uv = patch["uv"];
        for (const double s : {0.1, 0.5, 0.9})
            for (const double t : {0.2, 0.7}) {
                const double u = uv[0] + s * (uv[2] - uv[0]), v = uv[1] + t * (uv[3] - uv[1]);
                const glm::dvec3 expected = spline_place(spline, 0.5 + u * 2.5, 3 * v);
                CHECK(glm::distance(place(patch["points"], s, t), expected) < 1e-12);
            }
    }
}

TEST_CASE("faults of splines are named") {
    const std::string at = "nowhere/scene.glb: /nodes/0/extensions/ETD_optics/geometry";
    const auto error = [](const char* pointer, json value) {
        json spline = sail();
        spline[json::json_pointer(pointer)] = std::move(value);
        return import_error(with_geometry(spline).glb());
    };
    CHECK(error("/knots/0/3", -0.7).find(at + "/knots/0/3: is -0.7, less than the knot before") == 0);
    CHECK(error("/knots/1", {0, 0, 1, 1, 3, 3}).find(at + "/knots/1/3: is there more than 1 times") == 0);
    CHECK(error("/knots/1", {0, 0, 1}).find(at + "/knots/1: has 3 knots; allowed for degree 1") == 0);
    CHECK(error("/knots/1", {1, 1, 1, 1, 1}).find(at + "/knots/1: has no span") == 0);
    CHECK(error("/degree/0", 4).find(at + "/degree/0") == 0);
    CHECK(error("/weights/4", -1).find(at + "/weights/4") == 0);
    CHECK(error("/weights", {1, 2}).find(at + "/weights: has 2 weights; allowed: one a point, 21") == 0);
    CHECK(error("/control_points", {{0, 0, 0}}).find(at + "/control_points: has 1 points") == 0);
    CHECK(error("/size", 1).find(at + "/size") == 0);
}
