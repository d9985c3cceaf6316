// Media that bend rays together with everything else: bodies by priority, dispersion, fog, cameras and lights
// within them, the layers of an image, recorded paths.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "host/render/path_record.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

const json dielectric = {{"class", "dielectric"}}, boundary = {{"class", "boundary"}};

int body(SceneBuilder& s, const json& surface, const char* inside, int priority = 0) {
    json optics = {{"surface", surface}, {"inside", inside}};
    if (priority > 0) optics["priority"] = priority;
    return s.material(optics, {{"name", inside}});
}

json array(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// n² = ior² (1 - curvature · the squared distance from the centre)
json lens(const json& ior, double curvature, const glm::dvec3& center, double tolerance) {
    return {{"class", "gradient_index"},    {"ior", ior},
            {"radial", {-curvature, 0, 0}}, {"axial", {0, -curvature, 0}},
            {"center", array(center)},      {"tolerance", tolerance}};
}

}  // namespace

TEST_CASE("bodies of graded index by priority, with others in and around them, are invisible in a furnace") {
    SceneBuilder s;
    s.medium("low", lens({{"cauchy", {1.7, 0.01}}}, 0.4, {-1.5, 0, 0}, 1e-4));
    s.medium("high", lens(1.5, 0.4, {1.5, 0, 0}, 1e-4));
    s.medium("glass", {{"ior", {{"name", "SF11 ior"}}}});
    const int glass = body(s, dielectric, "glass", 2);
    for (const bool above : {false, true}) {
        const double x = above ? 1.5 : -1.5;
        s.sphere(1, body(s, dielectric, above ? "high" : "low", above ? 3 : 1), at(x, 0, 0));
        add_box(s, {1, 1, 1}, glass, false, at(x + 0.6, 0.3, 0.2));
        s.sphere(0.4, glass, at(x - 0.3, -0.2, 0.1));
    }
    s.environment(1);
    s.orthographic(1, at(0, 0, 5));
    Scene scene = compile_test_scene(s.import());
    REQUIRE(scene.features.spectral);
    RenderPlan plan;
    plan.width = 36, plan.height = 12, plan.passes = 64, plan.seeds = 8;
    const Estimates e = render_estimates(scene, plan);
    const WindowMean m = window_mean(e);
    MESSAGE("mean ", m.mean, " +- ", m.standard_error);
    CHECK(m.standard_error < 0.01);
    CHECK(std::fabs(m.mean - 1) < 1e-4 + 4 * m.standard_error);
    CHECK(e.counters.depth_limit == 0);
    CHECK(e.counters.non_finite == 0);
}

TEST_CASE("a camera within a medium sees radiance times its squared index there") {
    constexpr double n0 = 1.7, curvature = 0.5;
    const glm::dvec3 camera{0.4, 0.2, 0.3};
    SceneBuilder s;
    s.medium("lens", lens(n0, curvature, {0, 0, 0}, 1e-4));
    s.sphere(1, body(s, dielectric, "lens"), at(0, 0, 0));
    s.environment({0.5, 1, 2});
    s.perspective(1.5, at(camera.x, camera.y, camera.z));
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 64, plan.seeds = 4;
    const Estimates e = render_estimates(s.import(), plan);
    const WindowMean m = window_mean(e, {}, 1);
    const double expected = n0 * n0 * (1 - curvature * glm::dot(camera, camera));
    MESSAGE("seen ", m.mean, " +- ", m.standard_error, ", expected ", expected);
    CHECK(m.standard_error < 0.005 * expected);
    CHECK(std::fabs(m.mean - expected) < 1e-4 * expected + 4 * m.standard_error);
}

TEST_CASE("a point light within a Luneburg lens, at its edge, leaves it as a parallel beam") {
    // What leaves at the angle t to the axis leaves the other side at the distance sin t from it: intensity
    // over cos t falls on a screen (Luneburg 1944; a lens of radius 1).
    constexpr double intensity = 3, albedo = 0.8, h = 0.3, half = 0.2, turn = std::numbers::pi / 3;
    SceneBuilder s;
    s.medium("lens", lens(std::sqrt(2.0), 0.5, {0, 0, 0}, 5e-4));
    s.sphere(1, body(s, boundary, "lens"), at(0, 0, 0));
    s.light({{"type", "point"}, {"intensity", intensity}}, at(0, 0, -0.9995));
    s.rectangle(4, 4, s.lambertian(albedo), {{0, 0, 2}, {0, 1, 0, 0}});
    // Seen from beside the lens, 60 degrees off the screen's normal.
    s.orthographic(
        half, {{h + 2 * std::sin(turn), 0, 2 - 2 * std::cos(turn)}, {0, std::sin(turn), 0, std::cos(turn)}});
    double expected = 0;
    constexpr int n = 200;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double x = h + (2 * (i + 0.5) / n - 1) * half / std::cos(turn),
                         y = (2 * (k + 0.5) / n - 1) * half;
            expected += albedo / std::numbers::pi * intensity / std::sqrt(1 - x * x - y * y) / (n * n);
        }
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 32, plan.passes = 32, plan.seeds = 8;
    plan.merge_radius = 0.5f;
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        const std::string name = algorithm_name(algorithm);
        CAPTURE(name);
        plan.algorithm = algorithm;
        const WindowMean m = window_mean(render_estimates(scene, plan));
        MESSAGE(name, ": seen ", m.mean, " +- ", m.standard_error, ", expected ", expected);
        CHECK(m.standard_error < 0.01 * expected);
        CHECK(std::fabs(m.mean - expected) < 0.003 * expected + 4 * m.standard_error);
    }
}

namespace {

// A lens of dispersive material that is in part in fog and in part in flint glass, which keeps its place; the
// camera stands in a fish-eye.
SceneBuilder room_of_everything() {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.medium("fog", {{"ior", 1}, {"scattering", {0.6, 0.5, 0.4}}, {"absorption", 0.1}});
    s.medium("lens", lens({{"cauchy", {1.5, 0.01}}}, 0.8, {0.1, -0.9, -0.2}, 1e-3));
    s.medium("glass", {{"ior", {{"name", "SF11 ior"}}}, {"absorption", {0.1, 0.3, 0.6}}});
    s.medium(
        "eye",
        {{"class", "fish_eye"}, {"ior", 1.2}, {"radius", 0.9}, {"center", {0, 0, 1.8}}, {"tolerance", 1e-3}});
    s.sphere(0.8, body(s, boundary, "fog", 1), at(-0.6, -0.9, 0));
    s.sphere(0.7, body(s, dielectric, "lens", 2), at(0.1, -0.9, -0.2));
    add_box(s, {0.8f, 0.9f, 0.8f}, body(s, dielectric, "glass", 3), false, at(0.8, -1.4, 0.2));
    s.sphere(0.4, body(s, boundary, "eye"), at(0, 0, 1.8));
    return s;
}

}  // namespace

TEST_CASE("forward flux through bodies that bend, disperse and scatter: what is emitted is accounted for") {
    SceneBuilder s = room_of_everything();
    s.light({{"type", "point"}, {"intensity", 2}}, at(0, 0, 1.7));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 32, plan.passes = 32, plan.seeds = 1;
    plan.algorithm = Algorithm::forward;
    const RenderCounters c = render_estimates(scene, plan).counters;
    const double paths = double(c.forward_paths), emitted = c.emitted / paths, roulette = c.roulette / paths,
                 escaped = c.forward_escaped / paths;
    MESSAGE("emitted ", emitted, ", absorbed ", c.absorbed / paths, ", escaped ", escaped, ", roulette ",
            roulette, ", lost ", c.forward_depth_limit_lost / paths);
    CHECK(emitted == doctest::Approx((c.absorbed + c.forward_depth_limit_lost) / paths + escaped + roulette)
                         .epsilon(0.001));
    CHECK(c.forward_depth_limit == 0);
    CHECK(escaped < 1e-4);
    CHECK(std::fabs(roulette) < 0.01);
}

TEST_CASE("algorithms agree: graded index with priorities, dispersion, fog and around the camera" *
          doctest::test_suite("long")) {
    Comparison c;
    c.backward = 192, c.bidirectional = 48;
    c.forward = 0;  // everything is seen through a bend, so that forward rays alone bring nothing
    c.largest_error = 0.01;
    check_against_backward(room_of_everything(), c);
}

namespace {

constexpr double ior = 1.6, g = 0.8;                       // of a rod along z, 1/m
constexpr double start = 1.9, end = -2, tolerance = 2e-5;  // m

// From a camera within the rod to a wall aslant behind it; in the middle of the rod a ball that gives way to
// it.
SceneBuilder rod_from_within(bool has_ball) {
    SceneBuilder s;
    s.medium(
        "rod",
        {{"class", "gradient_index"}, {"ior", ior}, {"radial", {-g * g, 0, 0}}, {"tolerance", tolerance}});
    s.medium("glass", {{"ior", 1.5}});
    add_box(s, {2, 2, 4}, body(s, boundary, "rod", 2), false, at(0, 0, 0));
    s.sphere(0.4, body(s, boundary, "glass", 1), has_ball ? at(0, 0, 0) : at(0, 0, 9));
    s.rectangle(20, 20, s.lambertian(0.5), {{0, 0, -4}, {0, 0.2588, 0, 0.9659}});
    s.orthographic(0.15, at(0.6, 0, start));
    return s;
}

std::vector<RecordedPath> paths_of(Scene& scene, const RenderSettings& settings) {
    PathRecorder recorder(test_device(), scene, settings, false);
    std::vector<uint32_t> all(recorder.paths_a_pass());
    std::iota(all.begin(), all.end(), 0u);
    return recorder.record(0, all);
}

}  // namespace

TEST_CASE("recorded paths and depths follow bent rays, also past faces that are not there") {
    std::vector<glm::dvec3> alone;  // where paths meet the wall
    for (const bool has_ball : {false, true}) {
        CAPTURE(has_ball);
        Scene scene = compile_test_scene(rod_from_within(has_ball).import());
        REQUIRE(scene.features.body_count == 2);
        RenderSettings settings;
        settings.width = 8, settings.height = 6;
        settings.receiver = scene.receivers.at(0).ref;
        Renderer renderer(test_device(), scene, settings);
        Image image = renderer.develop(false);
        renderer.add_aovs(image, 1);
        const auto depth = plane(image, size_t(find_channel(image, "depth.Z")));
        double off_curve = 0, off_depth = 0, off_alone = 0;
        for (const RecordedPath& path : paths_of(scene, settings)) {
            const auto& v = path.vertices;
            const glm::dvec3 p = v[0].position;
            // Both coordinates are r cos(ior g t), z falls by n t, where n is the index at the start.
            const double r2 = p.x * p.x + p.y * p.y, n = ior * std::sqrt(1 - g * g * r2),
                         last = (start - end) / n;
            const auto turned = [&](double t) { return std::cos(ior * g * t); };
            size_t k = 1;
            for (; v.at(k).event == PathEvent::bent; ++k) {
                CHECK(v[k].object == "rod");
                const double c = turned((start - v[k].position.z) / n);
                off_curve =
                    std::max(off_curve, std::hypot(v[k].position.x - p.x * c, v[k].position.y - p.y * c));
            }
            CHECK(k > 8);
            REQUIRE(v[k].event == PathEvent::straight);
            CHECK(v[k].object == "rod");
            CHECK(std::abs(v[k].position.z - end) < 1e-5);
            double way = 0;
            constexpr int steps = 1000;
            for (int i = 0; i < steps; ++i)
                way += ior * std::sqrt(1 - g * g * r2 * std::pow(turned(last * (i + 0.5) / steps), 2)) *
                       last / steps;
            off_depth = std::max(off_depth, std::abs(double(depth[path.index]) - way));
            if (!has_ball) alone.push_back(v.at(k + 1).position);
            off_alone = std::max(off_alone, glm::length(v.at(k + 1).position - alone.at(path.index)));
        }
        MESSAGE("off the curve ", off_curve, ", of its length ", off_depth, ", of the rod alone ", off_alone);
        CHECK(off_curve < 3 * tolerance);
        CHECK(off_depth < 3 * tolerance);
        CHECK(off_alone < 20 * tolerance);
    }
}
