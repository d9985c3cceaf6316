// Media whose refractive index varies in space, in whole renders.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

int bounded(SceneBuilder& s, const json& surface, const char* inside) {
    return s.material({{"surface", surface}, {"inside", inside}});
}

}  // namespace

TEST_CASE("bodies of graded index that lose nothing are invisible in a furnace") {
    SceneBuilder s;
    s.medium("rod", {{"class", "gradient_index"},
                     {"ior", 1.6},
                     {"radial", {-0.5, 0.1, 0}},
                     {"axial", {0.1, 0, 0}},
                     {"center", {-2.5, 0, 0}},
                     {"axis", {0.2, 0.1, 1}},
                     {"tolerance", 1e-4}});
    s.medium("lens", {{"class", "gradient_index"},
                      {"ior", 1.8},
                      {"radial", {-0.5, 0, 0}},
                      {"axial", {0, -0.5, 0}},
                      {"tolerance", 1e-4}});
    s.medium(
        "eye",
        {{"class", "fish_eye"}, {"ior", 2.2}, {"radius", 1.6}, {"center", {2.5, 0, 0}}, {"tolerance", 1e-4}});
    add_box(s, {1.6f, 1.4f, 1.5f}, bounded(s, {{"class", "dielectric"}}, "rod"), false, at(-2.5, 0, 0));
    s.sphere(1, bounded(s, {{"class", "dielectric"}}, "lens"), at(0, 0, 0));
    s.sphere(1, bounded(s, {{"class", "dielectric"}, {"alpha", 0.3}, {"multiscatter", true}}, "eye"),
             at(2.5, 0, 0));
    s.environment({0.5, 1, 2});
    s.orthographic(1.25, at(0, 0, 5));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = 48, plan.height = 16, plan.passes = 32, plan.seeds = 4;
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
        const std::string name = algorithm_name(algorithm);
        CAPTURE(name);
        plan.algorithm = algorithm;
        const Estimates e = render_estimates(scene, plan);
        for (uint32_t body = 0; body < 3; ++body) {
            const WindowMean m = window_mean(e, {16 * body, 0, 16, 16}, 1);
            MESSAGE(name, ", body ", body, ": ", m.mean, " +- ", m.standard_error);
            const double tolerance = body < 2 ? 1e-5 : 0.005;  // rough: what the fit of its lobes lacks
            CHECK(m.standard_error < (body < 2 ? 1e-3 : 0.02));
            CHECK(std::fabs(m.mean - 1) < tolerance + 4 * m.standard_error);
        }
        CHECK(e.counters.depth_limit == 0);
        CHECK(e.counters.non_finite == 0);
    }
}

namespace {

// In a room with a wide lamp: a ball that focuses, a block whose index changes across and along it, and
// absorbs, a rough ball.
SceneBuilder room_of_lenses() {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.medium("lens", {{"class", "gradient_index"},
                      {"ior", 1.7},
                      {"radial", {-0.9, 0, 0}},
                      {"axial", {0, -0.9, 0}},
                      {"center", {-0.9, -1.2, 0.2}},
                      {"tolerance", 1e-3}});
    s.sphere(0.6, bounded(s, {{"class", "dielectric"}}, "lens"), at(-0.9, -1.2, 0.2));
    s.medium("block", {{"class", "gradient_index"},
                       {"ior", 1.5},
                       {"absorption", {0.1, 0.3, 0.6}},
                       {"radial", {-0.6, 0.2, 0}},
                       {"axial", {0.2, 0, 0.1}},
                       {"center", {0.8, -1, 0.3}},
                       {"axis", {0.2, 1, 0.1}},
                       {"tolerance", 1e-3}});
    add_box(s, {0.8f, 1.4f, 0.6f}, bounded(s, {{"class", "dielectric"}}, "block"), false,
            {{0.8, -1.1, 0.3}, {0, 0.3, 0, 0.954}});
    s.medium("eye", {{"class", "fish_eye"}, {"center", {0, 0.2, -1}}, {"radius", 0.8}, {"tolerance", 1e-3}});
    s.sphere(0.6, bounded(s, {{"class", "dielectric"}, {"alpha", 0.3}}, "eye"), at(0, 0.2, -1));
    return s;
}

}  // namespace

TEST_CASE("algorithms agree: bodies of graded index under a lamp") {
    Comparison c;
    c.backward = 48, c.forward = 64, c.bidirectional = 16;
    c.largest_error = 0.01;
    check_against_backward(room_of_lenses(), c);
}

TEST_CASE("algorithms agree: bodies of graded index under a lamp, in many passes" *
          doctest::test_suite("long")) {
    check_against_backward(room_of_lenses());
}

// Nothing but the bend keeps light sampling, connections and their weights from going straight through.
TEST_CASE(
    "algorithms agree: graded index within boundaries that are none, around the lamp, the floor and the "
    "camera") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    const auto graded = [&](const char* name, glm::dvec3 center, double ior) {
        s.medium(name, {{"class", "gradient_index"},
                        {"ior", ior},
                        {"absorption", {0.05, 0.1, 0.2}},
                        {"radial", {-0.5, 0, 0}},
                        {"axial", {0.2, 0, 0}},
                        {"center", {center.x, center.y, center.z}},
                        {"axis", {0.3, 1, 0.2}},
                        {"tolerance", 1e-3}});
        return bounded(s, {{"class", "boundary"}}, name);
    };
    s.sphere(0.7, graded("ball", {-0.9, -0.6, 0}, 1.3), at(-0.9, -0.6, 0));
    add_box(s, {0.8f, 0.8f, 0.8f}, s.lambertian(0.7), false, at(0.9, -1.6, 0));
    add_box(s, {1.6f, 1.6f, 1.4f}, graded("floor", {0.9, -1.4, 0}, 1.2), false, at(0.9, -1.4, 0));
    s.sphere(0.5, graded("camera", {0, 0, 1.8}, 1.1), at(0, 0, 1.8));
    Comparison c;
    c.backward = 96, c.forward = 0, c.bidirectional = 48;
    c.largest_error = 0.01;
    check_against_backward(s, c);
}

namespace {

void check_same_bits(Schedule schedule) {
    Scene scene = compile_test_scene(room_of_lenses().import());
    RenderPlan plan;
    plan.width = 16, plan.height = 12, plan.algorithm = Algorithm::bidirectional;
    const FilmState fused = render_film(scene, plan, Schedule::fused, {2}),
                    staged = render_film(scene, plan, schedule, {2});
    CHECK(fused.pixels == staged.pixels);
    CHECK(fused.counters.rays == staged.counters.rays);
    CHECK(fused.counters.forward_rays == staged.counters.forward_rays);
}

}  // namespace

TEST_CASE("bent rays give the same bits in one kernel and in a kernel a stage") {
    check_same_bits(Schedule::wavefront);
}

TEST_CASE("bent rays give the same bits in one kernel and in a kernel a class" *
          doctest::test_suite("long")) {
    check_same_bits(Schedule::by_class);
}

// Along the axis of a rod that is a quarter of a pitch long, parallel rays meet in the middle of the far
// face: they are bent, and so their way through the medium that absorbs is longer than the rod.
TEST_CASE("light is absorbed along its bent path") {
    constexpr double n0 = 1.6, g = 0.8, absorption = 0.9, r = 0.6;  // 1/m, m
    const double length = std::numbers::pi / (2 * g);
    SceneBuilder s;
    s.medium("rod", {{"class", "gradient_index"},
                     {"ior", n0},
                     {"radial", {-g * g, 0, 0}},
                     {"absorption", absorption},
                     {"center", {0, 0, length / 2}},
                     {"tolerance", 1e-5}});
    add_box(s, {3, 3, float(length)}, bounded(s, {{"class", "boundary"}}, "rod"), false, at(0, 0, 0));
    s.environment(1);
    s.orthographic(0.01, at(r, 0, 5));
    RenderPlan plan;
    plan.width = plan.height = 1, plan.passes = 4, plan.seeds = 2;
    const WindowMean seen = window_mean(render_estimates(s.import(), plan));
    // x = r cos(n0 g t), z = nz t, where nz is the index that the rays meet at first; their way is the
    // integral of n dt.
    const double nz = n0 * std::sqrt(1 - g * g * r * r), omega = n0 * g;
    double way = 0;
    constexpr int steps = 10000;
    const double t_end = length / nz;
    for (int i = 0; i < steps; ++i) {
        const double x = r * std::cos(omega * t_end * (i + 0.5) / steps);
        way += n0 * std::sqrt(1 - g * g * x * x) * t_end / steps;
    }
    const double end = r * std::cos(omega * t_end), n_end = n0 * std::sqrt(1 - g * g * end * end);
    // The boundary scales nothing, but along the bent path radiance goes with the squared index.
    const double expected = std::exp(-absorption * way) * nz * nz / (n_end * n_end);
    MESSAGE("seen ", seen.mean, ", expected ", expected, ", straight on ", std::exp(-absorption * length));
    CHECK(seen.mean == doctest::Approx(expected).epsilon(1e-3));
}
