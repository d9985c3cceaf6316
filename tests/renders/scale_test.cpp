// The same scene a thousand times smaller, ten thousand times larger, or far from the origin: the same image,
// no light that leaks through closed walls, and no wall that hides what lies a hair in front of it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

struct Variant {
    std::string name;
    glm::dvec3 translation;
    double scale;
};

// The scenes below fill about 2 m.
const std::vector<Variant>& variants() {
    static const std::vector<Variant> list = {{"as it is", {0, 0, 0}, 1},
                                              {"a thousandth", {0, 0, 0}, 1e-3},
                                              {"ten thousand times", {0, 0, 0}, 1e4},
                                              {"ten thousand sizes away", {2e4, -1.3e4, 1.7e4}, 1}};
    return list;
}

const nlohmann::json turned = {0.17, 0.31, -0.23, 0.906};  // no wall along an axis

// A room with a sphere, a light and a mirror, seen from inside.
SceneBuilder room() {
    SceneBuilder scene;
    add_box(scene, {2, 2, 2}, scene.lambertian({0.6, 0.4, 0.2}), true, Place{{0, 0, 0}, turned});
    scene.sphere(0.4, scene.lambertian(0.8), at(-0.3, -0.3, -0.2));
    scene.sphere(0.2, scene.surface({{"class", "conductor"}, {"reflectance", 0.9}}), at(0.4, -0.2, -0.1));
    scene.sphere(0.1, scene.black_emitter({3, 4, 5}), at(0.3, 0.5, 0.1));
    scene.perspective(1.1, at(0, 0, 0.7));
    return scene;
}

}  // namespace

TEST_CASE("the image of a scene does not depend on its scale and place") {
    RenderPlan plan;
    plan.width = plan.height = 24, plan.passes = 64, plan.seeds = 8;
    std::vector<Estimates> all;
    for (size_t i = 0; i < variants().size(); ++i) {
        SceneBuilder scene = room();
        scene.transform(variants()[i].translation, variants()[i].scale);
        plan.first_seed = uint32_t(1 + 100 * i);
        all.push_back(render_estimates(scene.import(), plan));
    }
    // All together are the expected image of each; the noise of the mean is that of as many seeds.
    for (size_t i = 1; i < all.size(); ++i) {
        CAPTURE(variants()[i].name);
        std::vector<double> sd(all[0].mean.size());
        for (size_t k = 0; k < sd.size(); ++k) {
            double squares = 0;
            for (const auto& image : all[0].images)
                squares += (image[k] - all[0].mean[k]) * (image[k] - all[0].mean[k]);
            sd[k] = std::sqrt(squares / (plan.seeds - 1.0) / plan.seeds);
        }
        for (const uint32_t tile : {1u, 4u}) {
            const Agreement a = agreement(all[i], all[0].mean, tile, sd);
            CHECK_MESSAGE(a.holds, describe(a));
        }
        const WindowMean m = window_mean(all[i]), m0 = window_mean(all[0]);
        CHECK(std::fabs(m.mean - m0.mean) < 4 * std::hypot(m.standard_error, m0.standard_error));
        CHECK(m.standard_error < 0.006 * m.mean);  // the lamp in the small mirror is met rarely
    }
}

TEST_CASE("no light enters a closed box, whatever its scale and place") {
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        SceneBuilder scene;
        add_box(scene, {2, 2, 2}, scene.lambertian(0.9), true, Place{{0, 0, 0}, turned});
        scene.sphere(0.5, scene.lambertian(0.9), at(-0.3, -0.4, -0.2));
        scene.light({{"type", "point"}, {"intensity", 1e12}}, at(0, 3, 0));
        scene.environment(1e6);
        scene.perspective(1.5, at(0, 0, 0.7));
        scene.transform(variant.translation, variant.scale);
        RenderPlan plan;
        plan.width = plan.height = 96, plan.passes = 64, plan.seeds = 1;
        const Estimates e = render_estimates(scene.import(), plan);
        CHECK(*std::max_element(e.mean.begin(), e.mean.end()) == 0);
        CHECK(e.counters.escaped == 0);
        CHECK(e.counters.rays > 4'000'000);  // so that a leak at the edges, of one path in a million, shows
    }
}

TEST_CASE("shells 4e-5 apart hide and light each other") {
    constexpr double gap = 4e-5;
    for (const Variant& variant : variants()) {
        CAPTURE(variant.name);
        SceneBuilder scene;
        const int black = scene.surface({{"class", "absorber"}}), emitter = scene.black_emitter(1);
        // A bright sphere in a black shell; a black sphere in a bright shell; white under a bright ceiling,
        // seen from between.
        scene.sphere(1, emitter, at(0, 0, 0));
        scene.sphere(1 + gap, black, at(0, 0, 0));
        scene.sphere(1, black, at(3, 0, 0));
        scene.sphere(1 + gap, emitter, at(3, 0, 0));
        scene.rectangle(4, 4, scene.lambertian(0.5), at(8, 0, 0));
        scene.rectangle(4, 4, emitter, facing_down(8, 0, gap));
        const double view = 1.2 * variant.scale;  // m: a camera does not grow with its node
        scene.orthographic(view, at(0, 0, 3), "hidden");
        scene.orthographic(view, at(3, 0, 3), "bright");
        scene.orthographic(view, at(8, 0, gap / 2), "between");
        scene.transform(variant.translation, variant.scale);
        Scene compiled = compile_test_scene(scene.import());
        RenderPlan plan;
        plan.width = plan.height = 32, plan.passes = 64, plan.seeds = 4;
        plan.receiver = "hidden";
        const Estimates hidden = render_estimates(compiled, plan);
        CHECK(*std::max_element(hidden.mean.begin(), hidden.mean.end()) == 0);
        plan.receiver = "bright";
        const Estimates bright = render_estimates(compiled, plan);
        for (uint32_t y = 0; y < 32; ++y)
            for (uint32_t x = 0; x < 32; ++x)
                if (std::hypot(x - 15.5, y - 15.5) < 0.9 / 1.2 * 16)
                    CHECK(bright.at(x, y, 0) == doctest::Approx(1));
        // The ceiling fills the whole half space.
        plan.receiver = "between";
        const WindowMean m = window_mean(render_estimates(compiled, plan));
        CHECK(std::fabs(m.mean - 0.5) < 0.0025 + 4 * m.standard_error);
    }
}
