// Lens surfaces in scenes: what the geometry class `asphere` does to a beam.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/lens/surface_shape.h"
#include "tests/support/render_probe.h"

using namespace etendue;
using std::numbers::pi;

namespace {

// Of unpolarized light at an interface, by Fresnel's equations.
double transmittance(double index, double index_behind, double cosine) {
    const double sine = index / index_behind * std::sqrt(1 - cosine * cosine),
                 behind = std::sqrt(1 - sine * sine);
    const double s = (index * cosine - index_behind * behind) / (index * cosine + index_behind * behind),
                 p = (index_behind * cosine - index * behind) / (index_behind * cosine + index * behind);
    return 1 - 0.5 * (s * s + p * p);
}

// The part of a beam of 100 units, 40 mm wide, that a plano-convex lens of glass (n = 1.5) with a focal
// length of 100 mm brings onto a spot of 0.2 mm in its focus.
double focused(double conic) {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}});
    const auto glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    s.shape({{"class", "disk"}, {"radius", 0.03}}, glass, {{0, 0, 0.13}});
    s.shape({{"class", "asphere"}, {"curvature", -20}, {"conic", conic}, {"aperture", 0.03}}, glass,
            {{0, 0, 0.1}, {1, 0, 0, 0}});
    s.placed("light", {{"class", "collimated"}, {"radius", 0.02}, {"power", 100}}, {{0, 0, 0.5}});
    const double side = 2e-4;
    s.placed("receiver", {{"class", "illuminance"}, {"size", {side, side}}, {"resolution", {1, 1}}},
             {{0, 0, 0}});
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 1;
    plan.algorithm = Algorithm::forward;
    plan.forward_paths = 4096, plan.passes = 64;
    return window_mean(render_estimates(scene, plan)).mean * side * side;
}

}  // namespace

TEST_CASE("a plano-hyperbolic lens brings a beam to one point, a spherical one does not") {
    const SurfaceShape hyperboloid{-20, -2.25};
    double expected = 0;
    const int rings = 2000;
    for (int i = 0; i < rings; ++i) {
        const double r = 0.02 * (i + 0.5) / rings;
        const double cosine = hyperboloid.normal({r, 0, hyperboloid.sag(r, 0)}).z;
        expected += 100 * transmittance(1, 1.5, 1) * transmittance(1.5, 1, cosine) * (2 * i + 1) /
                    (double(rings) * rings);
    }
    CHECK(focused(-2.25) == doctest::Approx(expected).epsilon(0.003));
    CHECK(focused(0) < 0.1 * expected);
}
