// Sheets with many small bumps or dents against single shapes, closed forms and furnaces. (Intersections in
// double precision: tests/contracts/geometry_test.cpp.)
#include <doctest/doctest.h>

#include <cmath>

#include "tests/renders/algorithm_comparison.h"
#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = 3.14159265358979323846;

json sheet(const json& more = json::object()) {
    json parameters = {{"size", {1, 1}}, {"pitch", {0.01, 0.01}}, {"radius", 0.004}, {"depth", 0.004}};
    parameters.update(more);
    return parameters;
}
const Box sheet_box{{-0.5f, -0.5f, -0.004f}, {0.5f, 0.5f, 0.004f}};

// Rays that come down to the plane z = 0 at an angle from its normal, towards even places of it.
std::vector<ProbeRay> slanted_rays(size_t count, double angle) {
    Random random(3);
    std::vector<ProbeRay> rays;
    for (size_t i = 0; i < count; ++i) {
        const double azimuth = random(0, float(2 * pi));
        const glm::dvec3 d(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
                           -std::cos(angle));
        const glm::dvec3 target(random(-0.46f, 0.46f), random(-0.46f, 0.46f), 0);
        rays.push_back({target - 0.02 * d, 1e30f, d});
    }
    return rays;
}

}  // namespace

TEST_CASE("ten thousand bumps are where the spheres of the same places are") {
    const double radius = double(0.004f), pitch = double(0.01f);
    GeometryProbe bumps, spheres;
    bumps.add_shape("microstructure", sheet(), sheet_box, glm::dmat4(1));
    spheres.add_shape("rectangle", {{"size", {1, 1}}}, {{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}}, glm::dmat4(1));
    for (int row = 0; row < 100; ++row)
        for (int column = 0; column < 100; ++column) {
            glm::dmat4 place(1);
            place[3] = glm::dvec4((column - 49.5) * pitch, (row - 49.5) * pitch, 0, 1);
            spheres.add_shape("sphere", {{"radius", radius}}, {glm::vec3(-0.004f), glm::vec3(0.004f)}, place);
        }
    bumps.build(), spheres.build();
    const std::vector<ProbeRay> rays = slanted_rays(100000, 1.2);
    const auto a = bumps.trace(rays, false), b = spheres.trace(rays, false);
    size_t apart = 0, on_bumps = 0;
    double farthest = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        REQUIRE(a[i].hit.primitive != no_record);
        on_bumps += a[i].geometric_normal.z < 0.999f;
        const double distance = glm::length(a[i].position - b[i].position);
        // Floats at half a metre have steps of 6e-6 pitches. Where a ray grazes a bump either answer is
        // right.
        if (distance > 1e-4 * pitch)
            ++apart;
        else
            farthest = std::max(farthest, distance);
        if (distance < 1e-4 * pitch) CHECK(glm::length(a[i].geometric_normal - b[i].geometric_normal) < 1e-3);
    }
    MESSAGE(on_bumps, " on bumps, ", apart, " apart, others within ", farthest / pitch, " pitches");
    CHECK(on_bumps > rays.size() / 2);
    CHECK(apart <= 30);
}

// The shadows of hemispheres on their plane are half disks and half ellipses.
TEST_CASE("bumps hide of their plane what their shadows cover") {
    const double cover =
        pi * 0.4 * 0.4 / 16;  // in every other place of every other row, so that shadows stay apart
    GeometryProbe probe;
    probe.add_shape("microstructure", sheet({{"pitch", {0.04, 0.04}}}), sheet_box, glm::dmat4(1));
    probe.build();
    for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
        CAPTURE(degrees);
        const double angle = degrees * pi / 180;
        const size_t n = 400000;
        size_t plane = 0;
        for (const ProbeTrace& t : probe.trace(slanted_rays(n, angle), false))
            plane += t.geometric_normal.z > 0.999999f;
        const double expected = 1 - cover * (1 + 1 / std::cos(angle)) / 2, share = double(plane) / n;
        MESSAGE(share, ", expected ", expected);
        CHECK(std::fabs(share - expected) < 4 * std::sqrt(expected * (1 - expected) / n));
    }
}

// In a uniform field a body that loses nothing cannot be seen, whatever its faces are like.
TEST_CASE("glass with structured faces loses no light") {
    const char* const shapes[] = {"dome", "cone", "prism"};  // ridges are open at their ends
    for (const char* shape : shapes)
        for (const char* operation : {"add", "remove"}) {
            CAPTURE(shape);
            CAPTURE(operation);
            SceneBuilder s;
            s.environment({1, 1, 1});
            s.medium("glass", {{"ior", 1.5}});
            const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
            json structure = {{"class", "microstructure"},
                              {"size", {1, 1}},
                              {"pitch", {0.1, 0.1}},
                              {"radius", 0.04},
                              {"depth", 0.03},
                              {"shape", shape},
                              {"operation", operation}};
            s.shape(structure, glass, at(0, 0, 0.1));
            s.rectangle(1, 1, glass, {{0, 0, -0.1}, {1, 0, 0, 0}});
            const double h = std::sqrt(0.5);
            const json turns[] = {{0, h, 0, h}, {0, -h, 0, h}, {-h, 0, 0, h}, {h, 0, 0, h}};
            for (int i = 0; i < 4; ++i) {
                const double side = i % 2 ? -0.5 : 0.5;
                s.rectangle(i < 2 ? 0.2 : 1, i < 2 ? 1 : 0.2, glass,
                            {{i < 2 ? side : 0.0, i < 2 ? 0.0 : side, 0}, turns[i]});
            }
            s.perspective(0.9, at(0.2, -0.1, 1.4));
            RenderPlan plan;
            plan.width = plan.height = 32, plan.passes = 16, plan.seeds = 1;
            const Estimates e = render_estimates(s.import(), plan);
            size_t off = 0;
            for (const double v : e.mean) off += std::fabs(v - 1) > 1e-4;
            CHECK(off == 0);
        }
}

// Both slopes reflect everything: light that comes to the flat side goes back to it.
TEST_CASE("a film of prisms of 90 degrees sends light back that comes straight from its flat side") {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}});
    const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    s.rectangle(1, 1, glass, {{0, 0, -0.1}, {1, 0, 0, 0}});
    s.shape({{"class", "microstructure"},
             {"size", {1, 1}},
             {"pitch", {0.02, 1}},
             {"radius", 0.01},
             {"depth", 0.01},
             {"shape", "groove"}},
            glass, at(0, 0, 0));
    s.placed("light", {{"class", "collimated"}, {"radius", 0.3}, {"power", 1}}, {{0, 0, -1}, {0, 1, 0, 0}});
    s.placed("receiver", {{"class", "illuminance"}, {"size", {1, 1}}, {"resolution", {1, 1}}},
             {{0, 0, 0.5}, {1, 0, 0, 0}});
    s.document["nodes"].back()["name"] = "through";
    s.placed("receiver", {{"class", "illuminance"}, {"size", {1, 1}}, {"resolution", {1, 1}}},
             at(0, 0, -0.5));
    s.document["nodes"].back()["name"] = "back";
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 1, plan.algorithm = Algorithm::forward, plan.forward_paths = 20000,
    plan.passes = 1, plan.seeds = 4;
    const auto flux = [&](size_t receiver) {
        plan.receiver = scene.receivers[receiver].name;
        return window_mean(render_estimates(scene, plan)).mean;
    };
    CHECK(scene.receivers.size() == 2);
    const double through = flux(0), back = flux(1);
    MESSAGE(through, " through, ", back, " back");
    CHECK(through < 1e-4 * back);
}
