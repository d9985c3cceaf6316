// What forward rays carry is accounted for: the power balance, full vertex buffers.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double half_turn = 0.70710678118654752;

// Something of everything: media, refraction, straight passage, rough and smooth, lights of three kinds.
SceneBuilder varied_scene(float scattering = 1) {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5},
                       {"absorption", {0.2, 0.1, 0.4}},
                       {"scattering", {scattering, 2 * scattering, 0.5f * scattering}}});
    add_box(s, {4, 4, 4}, s.lambertian({0.7, 0.5, 0.3}), true, at(0, 0, 0));
    s.sphere(0.6, s.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.2}}}, {"inside", "glass"}}),
             at(-0.8, -1.2, 0.3));
    s.sphere(0.5, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
             at(0.9, -1.4, 0));
    s.rectangle(1.5, 1.5, s.surface({{"class", "thin_dielectric"}}), at(0, 0, 1));
    s.rectangle(2, 2, s.black_emitter({4, 5, 6}), {{0, 1.9, 0}, {half_turn, 0, 0, half_turn}});
    s.light({{"type", "point"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}}, at(1.2, 1.2, 1.2));
    s.perspective(1.2, at(0, 0, 1.95));
    return s;
}

// Of forward flux, per path.
struct Balance {
    double emitted, absorbed, escaped, lost, roulette;
};
Balance balance(const RenderCounters& c) {
    const double paths = double(c.forward_paths);
    return {c.emitted / paths, c.absorbed / paths, c.forward_escaped / paths,
            c.forward_depth_limit_lost / paths, c.roulette / paths};
}

Balance balance_of(const SceneBuilder& s, uint32_t passes, uint32_t seed) {
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 32, plan.passes = passes, plan.seeds = 1, plan.first_seed = seed;
    plan.algorithm = Algorithm::forward;
    return balance(render_estimates(scene, plan).counters);
}

}  // namespace

TEST_CASE("forward flux: all that is emitted is absorbed, escapes or is taken by roulette") {
    const Balance b = balance_of(varied_scene(), 128, 1);
    MESSAGE("emitted ", b.emitted, ", absorbed ", b.absorbed, ", escaped ", b.escaped, ", roulette ",
            b.roulette);
    CHECK(b.emitted == doctest::Approx(b.absorbed + b.escaped + b.lost + b.roulette).epsilon(0.001));
    CHECK(b.emitted == doctest::Approx(1).epsilon(0.001));
    CHECK(b.escaped < 1e-4);               // closed but for what slips through by rounding
    CHECK(std::fabs(b.roulette) < 0.005);  // 131072 paths; what it takes has mean 0
}

TEST_CASE("forward flux over a diffuse disk: what it absorbs is what it is seen to receive") {
    // A point light at height h over a disk of radius r: it fills 2 pi (1 - h / sqrt(h² + r²)) of its 4 pi.
    constexpr double h = 0.5, r = 1, kept = 0.4;
    SceneBuilder s;
    s.shape({{"class", "disk"}, {"radius", r}}, s.lambertian(kept), at(0, 0, 0));
    s.light({{"type", "point"}, {"intensity", 3}}, at(0, 0, h));
    s.orthographic(1, at(0, 0, 2));
    const Balance b = balance_of(s, 128, 2);
    const double received = 0.5 * (1 - h / std::sqrt(h * h + r * r));
    constexpr double paths = 128 * 32 * 32;
    const double error = std::sqrt(received * (1 - received) / paths);  // more than that of stratified paths
    CHECK(b.emitted == doctest::Approx(1).epsilon(1e-6));
    CHECK(std::fabs(b.absorbed - received * (1 - kept)) < 4 * error * (1 - kept));
    CHECK(std::fabs(b.escaped - (1 - received * (1 - kept))) < 4 * error * (1 - kept));
}

TEST_CASE("forward flux: nothing is absorbed where no surface absorbs") {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}});
    s.rectangle(4, 4, s.lambertian(1), at(0, 0, 0));
    s.sphere(0.5, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
             at(-0.6, 0, 0.6));
    s.sphere(0.5, s.surface({{"class", "conductor"}, {"reflectance", 1}}), at(0.6, 0, 0.6));
    s.rectangle(1, 1, s.surface({{"class", "thin_dielectric"}}), facing_down(0, 0.7, 1.2));
    s.light({{"type", "point"}, {"intensity", 3}}, at(0, 0, 2));
    s.orthographic(1, at(0, 0, 3));
    const Balance b = balance_of(s, 64, 3);
    CHECK(std::fabs(b.absorbed) < 1e-5);
    CHECK(b.escaped + b.lost + b.roulette == doctest::Approx(1).epsilon(1e-4));
    CHECK(std::fabs(b.roulette) < 0.005);
}

TEST_CASE("full vertex buffers make passes of fewer forward paths, and the same image" *
          doctest::test_suite("long")) {
    Scene scene = compile_test_scene(varied_scene(0).import());  // buffers are small where nothing scatters
    RenderPlan plan;
    plan.width = 64, plan.height = 64, plan.passes = 32, plan.seeds = 8;
    plan.algorithm = Algorithm::bidirectional, plan.merge_radius = 0.1f;
    const Estimates whole = render_estimates(scene, plan);
    CHECK(whole.counters.forward_paths == 8 * 32 * 64 * 64);
    plan.vertex_bytes = 4096, plan.first_seed = 101;
    const Estimates small = render_estimates(scene, plan);
    CHECK(small.counters.forward_paths < whole.counters.forward_paths / 2);
    CHECK(small.counters.forward_paths > 8 * 32 * 64);
    const Agreement pixels = agreement(small, whole, 1), tiles = agreement(small, whole, 8);
    const WindowMean a = window_mean(small), b = window_mean(whole);
    const double share = double(small.counters.forward_paths) / double(whole.counters.forward_paths);
    MESSAGE(share, " of the paths: pixels ", describe(pixels), "; tiles ", describe(tiles), "; means ",
            a.mean, " +- ", a.standard_error, " and ", b.mean, " +- ", b.standard_error);
    CHECK(pixels.holds);
    CHECK(tiles.holds);
    CHECK(std::fabs(a.mean - b.mean) < 0.002 * b.mean + 4 * std::hypot(a.standard_error, b.standard_error));
}
