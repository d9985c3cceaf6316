// Splines in scenes: as bodies of glass, and as lamps.
#include <doctest/doctest.h>

#include <numbers>

#include "tests/support/nurbs_shapes.h"
#include "tests/support/render_probe.h"

using namespace etendue;

TEST_CASE("glass in the shape of splines loses no light: it cannot be seen under an even sky") {
    SceneBuilder s;
    s.environment({1, 1, 1});
    s.medium("glass", {{"ior", 1.5}});
    const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    s.shape(nurbs_torus(0.6, 0.3), glass, {{0, 0, 0}, {0.3, 0, 0, 0.954}});
    s.shape(nurbs_sphere(0.28), glass, {{0, 0, 0}, {0.6, 0, 0, 0.8}});
    s.orthographic(1, at(0, 0, 3));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 48, plan.passes = 16, plan.seeds = 4;
    const auto mean = window_mean(render_estimates(scene, plan));
    CHECK(mean.mean == doctest::Approx(1).epsilon(0.001));
}

TEST_CASE("a lamp that is a sphere of splines lights as one, in every algorithm") {
    const double radius = 0.2, height = 1, side = 0.4;
    // As if all came from the middle, in the mean over the square below.
    double expected = 0;
    const int n = 64;
    for (int i = 0; i < n * n; ++i) {
        const double x = side * ((i % n + 0.5) / n - 0.5), y = side * ((i / n + 0.5) / n - 0.5);
        expected += 10 * std::numbers::pi * radius * radius * height /
                    std::pow(x * x + y * y + height * height, 1.5) / (n * n);
    }
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(int(algorithm));
        SceneBuilder s;
        const int emitter =
            s.material({{"surface", {{"class", "absorber"}}}, {"emission", {{"luminance", 10}}}});
        s.shape(nurbs_sphere(radius), emitter, {{0, 0, height}, {0.6, 0, 0, 0.8}});
        s.placed("receiver", {{"class", "illuminance"}, {"size", {side, side}}, {"resolution", {1, 1}}},
                 at(0, 0, 0));
        Scene scene = compile_test_scene(s.import());
        CHECK(scene.lights > 50);
        RenderPlan plan;
        plan.width = plan.height = 1, plan.algorithm = algorithm;
        plan.passes = algorithm == Algorithm::backward ? 512 : 128;
        plan.forward_paths = algorithm == Algorithm::forward ? 2048 : 64;
        const auto mean = window_mean(render_estimates(scene, plan));
        CHECK(std::abs(mean.mean - expected) < 4 * mean.standard_error + 1e-4 * expected);
        CHECK(mean.standard_error < 0.02 * expected);
    }
}
