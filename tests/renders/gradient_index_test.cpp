// Media whose refractive index varies in space, in whole renders.
#include <doctest/doctest.h>

#include <cmath>

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
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        const std::string name = algorithm_name(algorithm);
        CAPTURE(name);
        SceneBuilder s;
        s.medium("rod", {{"class", "gradient_index"}, {"ior", 1.6}, {"radial", {-0.5, 0.1, 0}}, {"axial", {0.1, 0, 0}},
                         {"center", {-2.5, 0, 0}}, {"axis", {0.2, 0.1, 1}}, {"tolerance", 1e-4}});
        s.medium("eye", {{"class", "fish_eye"}, {"ior", 2.2}, {"radius", 1.6}, {"center", {2.5, 0, 0}}, {"tolerance", 1e-4}});
        s.medium("lens", {{"class", "gradient_index"}, {"ior", std::sqrt(2)}, {"radial", {-0.5, 0, 0}}, {"axial", {0, -0.5, 0}}, {"tolerance", 1e-4}});
        add_box(s, {1.6f, 1.4f, 1.5f}, bounded(s, {{"class", "dielectric"}}, "rod"), false, at(-2.5, 0, 0));
        s.sphere(1, bounded(s, {{"class", "dielectric"}}, "lens"), at(0, 0, 0));
        s.sphere(1, bounded(s, {{"class", "dielectric"}, {"alpha", 0.3}, {"multiscatter", true}}, "eye"), at(2.5, 0, 0));
        s.environment({0.5, 1, 2});
        s.orthographic(1.25, at(0, 0, 5));
        RenderPlan plan;
        plan.width = 48, plan.height = 16, plan.passes = 16, plan.seeds = 4;
        plan.algorithm = algorithm;
        Scene scene = compile_test_scene(s.import());
        const Estimates e = render_estimates(scene, plan);
        for (int k = 0; k < 3; ++k) {
            const WindowMean m = window_mean(e, {uint32_t(16 * k), 0, 16, 16}, 1);
            MESSAGE(name, " body ", k, ": ", m.mean, " +- ", m.standard_error);
        }
        MESSAGE("depth limit ", e.counters.depth_limit, " rays ", e.counters.rays, " non finite ", e.counters.non_finite);
    }
}

namespace {

// In a room with a wide lamp: a ball that focuses, a block whose index changes across and along it, and absorbs,
// a rough ball.
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
    check_against_backward(room_of_lenses());
}
