// Sheets whose cells hold triangles of any shape, against the same triangles as ordinary geometry: ray by
// ray, in images, and in a furnace.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/renders/algorithm_comparison.h"
#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr int side = 3;  // squares of a cell along x and y

// Hills whose height is the same at opposite borders of the cell, so that cells fit together; or is 0 there.
std::vector<glm::vec3> hills(double pitch, bool flat_border) {
    const auto corner = [&](int x, int y) {
        const bool border = x % side == 0 || y % side == 0;
        const double height = flat_border && border ? 0
                                                    : 0.05 + 0.11 * ((x % side) * 2 % 3) -
                                                          0.13 * ((y % side + x % side) * 5 % 4 % 3);
        return glm::vec3(pitch * (double(x) / side - 0.5), pitch * (double(y) / side - 0.5), pitch * height);
    };
    std::vector<glm::vec3> corners;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
                corners.push_back(corner(x + i, y + j));
    return corners;
}

std::vector<ProbeRay> rays_to(size_t count, float half, float nearest, float farthest, float steepest) {
    Random random(11);
    std::vector<ProbeRay> rays(count);
    for (ProbeRay& r : rays) {
        const float away = random(nearest, farthest), slope = random(0, steepest),
                    azimuth = random(0, 6.283f);
        const glm::vec3 back(std::sin(slope) * std::cos(azimuth), std::sin(slope) * std::sin(azimuth),
                             std::cos(slope));
        r = {glm::vec3(random(-half, half), random(-half, half), 0) + away * back, 1e30f, -back};
    }
    return rays;
}

// Plücker's sides in double precision: where a ray meets a triangle, 1e30 = nowhere.
double meet(const glm::dvec3* v, const glm::dvec3& o, const glm::dvec3& d) {
    const glm::dvec3 n = glm::cross(v[1] - v[0], v[2] - v[0]);
    const double t = glm::dot(n, v[0] - o) / glm::dot(n, d);
    for (int i = 0; i < 3; ++i)
        if (glm::dot(glm::cross(v[(i + 1) % 3] - v[i], o + t * d - v[i]), n) < -1e-12 * glm::dot(n, n))
            return 1e30;
    return t > 0 ? t : 1e30;
}

// A scene of such cells at a place, of `columns` and `rows`.
int cell_scene(SceneBuilder& s, const std::vector<glm::vec3>& corners, int material) {
    std::vector<uint32_t> indices(corners.size());
    for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
    return s.scene([&] { s.mesh(corners, indices, material, at(0, 0, 0)); });
}

}  // namespace

TEST_CASE("ten thousand cells are where their triangles are as ordinary geometry") {
    const float pitch = 0.01f;
    for (const bool flat_border : {false, true}) {
        const std::vector<glm::vec3> corners = hills(pitch, flat_border);
        GeometryProbe cells, triangles;
        const uint32_t cell = cells.add_cell(corners);
        cells.add_shape("microstructure",
                        {{"size", {1, 1}},
                         {"pitch", {pitch, pitch}},
                         {"radius", pitch},
                         {"depth", pitch},
                         {"cell", cell}},
                        {{-0.5f, -0.5f, -0.01f}, {0.5f, 0.5f, 0.01f}}, glm::dmat4(1));
        for (int row = 0; row < 100; ++row)
            for (int column = 0; column < 100; ++column) {
                const glm::vec3 middle((column - 49.5) * double(pitch), (row - 49.5) * double(pitch), 0);
                for (size_t i = 0; i < corners.size(); i += 3)
                    triangles.add_triangle(middle + corners[i], middle + corners[i + 1],
                                           middle + corners[i + 2]);
            }
        cells.build(), triangles.build();
        const std::vector<ProbeRay> rays = rays_to(100000, 0.4f, 0.02f, 1, 1.5f);
        const auto a = cells.trace(rays, false), b = triangles.trace(rays, false);
        size_t missed = 0, apart = 0, other_normal = 0;
        double farthest = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (a[i].hit.primitive == no_record || b[i].hit.primitive == no_record || !a[i].occluded) {
                ++missed;
                continue;
            }
            const double distance = glm::length(a[i].position - b[i].position);
            if (distance > 1e-4 * double(pitch)) {
                ++apart;  // beside an edge
                continue;
            }
            farthest = std::max(farthest, distance);
            other_normal += glm::length(a[i].geometric_normal - b[i].geometric_normal) > 1e-3;
        }
        MESSAGE(missed, " missed, ", apart, " apart, ", other_normal, " beside an edge, others within ",
                farthest / double(pitch), " pitches");
        CHECK(missed == 0);
        CHECK(apart <= 30);
        CHECK(other_normal <= 60);
    }
}

TEST_CASE("cells of 20 µm are met where they are to a millionth of their pitch, from any distance") {
    const double pitch = double(20e-6f);
    const std::vector<glm::vec3> corners = hills(pitch, false);
    const int cells = int(double(0.5f) / pitch + 1e-3);
    GeometryProbe probe;
    const uint32_t cell = probe.add_cell(corners);
    probe.add_shape(
        "microstructure",
        {{"size", {0.5, 0.5}}, {"pitch", {20e-6, 20e-6}}, {"radius", 1e-5}, {"depth", 1e-5}, {"cell", cell}},
        {{-0.25f, -0.25f, -1e-5f}, {0.25f, 0.25f, 1e-5f}}, glm::dmat4(1));
    probe.build();
    for (const auto& [nearest, farthest] : {std::pair(5e-5f, 2e-4f), {0.01f, 0.1f}, {0.5f, 2.0f}}) {
        const std::vector<ProbeRay> rays = rays_to(20000, 0.24f, nearest, farthest, 1);
        const auto traces = probe.trace(rays, false);
        double off = 0;
        size_t missed = 0, apart = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const glm::dvec3 o(rays[i].origin), d(rays[i].direction);
            const glm::ivec2 around(glm::floor(glm::dvec2(o - o.z / d.z * d) / pitch + 0.5 * cells));
            double t = 1e30;
            for (int y = -2; y <= 2; ++y)
                for (int x = -2; x <= 2; ++x) {
                    const glm::dvec3 middle(
                        (glm::dvec2(around + glm::ivec2(x, y)) + 0.5 - 0.5 * cells) * pitch, 0);
                    for (size_t k = 0; k < corners.size(); k += 3) {
                        const glm::dvec3 v[3] = {glm::dvec3(corners[k]), glm::dvec3(corners[k + 1]),
                                                 glm::dvec3(corners[k + 2])};
                        t = std::min(t, meet(v, o - middle, d));
                    }
                }
            missed += traces[i].hit.primitive == no_record;
            // The second parameter is what the distance lacks.
            const double found = double(traces[i].hit.t) + double(traces[i].hit.uv.y),
                         distance = std::abs(found - t);
            if (distance > 1e-3 * pitch)
                ++apart;
            else
                // From the triangle: rays that graze it are off by more along their way.
                off = std::max(off, distance * std::abs(glm::dot(d, glm::dvec3(traces[i].geometric_normal))));
        }
        MESSAGE("from ", nearest, " to ", farthest, " m: ", missed, " missed, ", apart,
                " beside an edge, others within ", off / pitch, " pitches");
        CHECK(missed == 0);
        CHECK(apart <= 2);
        CHECK(off < 1e-6 * pitch);
    }
}

TEST_CASE("an image of cells is that of their triangles") {
    const double pitch = 0.1;
    const std::vector<glm::vec3> corners = hills(pitch, true);
    SceneBuilder plain, s;
    for (SceneBuilder* b : {&plain, &s}) {
        add_box(*b, {2, 2, 2}, b->lambertian({0.7, 0.7, 0.7}), true, at(0, 0, 0));
        b->rectangle(0.6, 0.6, b->black_emitter({9, 8, 7}), facing_down(0.3, 0.96, 0.2));
        b->perspective(0.9, at(0, 0.2, 0.97));
    }
    const json sheet = {
        {"class", "microstructure"}, {"size", {1, 1}}, {"pitch", {0.1, 0.1}}, {"cell_size", 0.1}};
    const Place place{{0, -0.1, -0.6}, {0, 0, 0, 1}};
    const int grey = s.lambertian({0.6, 0.5, 0.3});
    std::vector<glm::vec3> unit = corners;
    for (glm::vec3& p : unit) p *= 10.0f;
    json element = sheet;
    element["cell"] = cell_scene(s, unit, grey);
    element["material"] = grey;
    s.placed("element", element, place);

    const int same = plain.lambertian({0.6, 0.5, 0.3});
    std::vector<glm::vec3> all;
    std::vector<uint32_t> indices;
    for (int cell = 0; cell < 100; ++cell)
        for (const glm::vec3& p : corners)
            all.push_back(p + glm::vec3((cell % 10 - 4.5) * 0.1, (cell / 10 - 4.5) * 0.1, 0));
    for (uint32_t i = 0; i < all.size(); ++i) indices.push_back(i);
    plain.mesh(all, indices, same, place);

    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.passes = 64;
    const Estimates expected = render_estimates(plain.import(), plan);
    plan.first_seed = 501;
    check_agreement("cells", render_estimates(s.import(), plan), expected, 0.002, 0.01);
}

// In a uniform field a body that loses nothing cannot be seen. Some cells are empty: the plane is there.
TEST_CASE("glass with cells of any shape loses no light") {
    SceneBuilder s;
    s.environment({1, 1, 1});
    s.medium("glass", {{"ior", 1.5}});
    const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    const int cell = cell_scene(s, hills(0.1, true), glass);
    s.shape({{"class", "microstructure"},
             {"size", {1, 1}},
             {"pitch", {0.1, 0.1}},
             {"cell", cell},
             {"density", 0.7}},
            glass, at(0, 0, 0.1));
    s.rectangle(1, 1, glass, {{0, 0, -0.1}, {1, 0, 0, 0}});
    const double h = std::sqrt(0.5);
    const json turns[] = {{0, h, 0, h}, {0, -h, 0, h}, {-h, 0, 0, h}, {h, 0, 0, h}};
    for (int i = 0; i < 4; ++i) {
        const double end = i % 2 ? -0.5 : 0.5;
        s.rectangle(i < 2 ? 0.2 : 1, i < 2 ? 1 : 0.2, glass,
                    {{i < 2 ? end : 0.0, i < 2 ? 0.0 : end, 0}, turns[i]});
    }
    s.perspective(0.9, at(0.2, -0.1, 1.4));
    RenderPlan plan;
    plan.width = plan.height = 32, plan.passes = 16, plan.seeds = 1;
    size_t off = 0;
    for (const double v : render_estimates(s.import(), plan).mean) off += std::fabs(v - 1) > 1e-4;
    CHECK(off == 0);
}
