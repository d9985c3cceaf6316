// The image does not depend on how the work is divided: whole paths in one kernel or a kernel a stage, in one
// batch of passes or many, without or with a stop between.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

// Something of everything that has a path of its own: media, straight passage, refraction, meshes, shapes,
// instances of light.
SceneBuilder varied_scene() {
    SceneBuilder scene;
    scene.medium("glass", {{"ior", 1.5}, {"absorption", {0.2, 0.1, 0.4}}});
    add_box(scene, {4, 4, 4}, scene.lambertian({0.7, 0.5, 0.3}), true, at(0, 0, 0));
    scene.sphere(
        0.6, scene.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.2}}}, {"inside", "glass"}}),
        at(-0.8, -1.2, 0.3));
    scene.sphere(0.5,
                 scene.surface({{"class", "conductor"}, {"alpha", 0.1}, {"reflectance", {0.9, 0.8, 0.5}}}),
                 at(0.9, -1.4, 0));
    scene.rectangle(1.5, 1.5, scene.surface({{"class", "thin_dielectric"}}), at(0, 0, 1));
    scene.rectangle(1, 1, scene.black_emitter({4, 5, 6}),
                    Place{{0, 1.9, 0}, {0.70710678118654752, 0, 0, 0.70710678118654752}});
    scene.light({{"type", "point"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}}, at(1.2, 1.2, 1.2));
    scene.environment(0.1);
    scene.perspective(1.2, at(0, 0, 1.95));
    return scene;
}

bool same_bits(const FilmState& a, const FilmState& b) {
    return a.passes == b.passes && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size()) == 0;
}

}  // namespace

TEST_CASE("fused and wavefront schedules, batches and resumption give the same film, bit for bit") {
    Scene scene = compile_test_scene(varied_scene().import());
    RenderPlan plan;
    plan.width = 40, plan.height = 24, plan.first_seed = 5;
    const FilmState fused = render_film(scene, plan, Schedule::fused, {16});
    CHECK(same_bits(fused, render_film(scene, plan, Schedule::fused, {1, 10, 5})));
    const FilmState wavefront = render_film(scene, plan, Schedule::wavefront, {16});
    CHECK(same_bits(fused, wavefront));
    CHECK(same_bits(fused, render_film(scene, plan, Schedule::wavefront, {3, 13})));
    CHECK(same_bits(fused, render_film(scene, plan, Schedule::by_class, {16})));
    CHECK(fused.counters.rays == wavefront.counters.rays);
    CHECK(fused.counters.shadow_rays == wavefront.counters.shadow_rays);
    CHECK(fused.counters.escaped == doctest::Approx(wavefront.counters.escaped).epsilon(1e-6));
    // The film holds something, and another seed gives other bits.
    RenderPlan other = plan;
    other.first_seed = 6;
    CHECK(!same_bits(fused, render_film(scene, other, Schedule::fused, {16})));

    // Through the state of a film, as a checkpoint holds it, into a new renderer of the other schedule.
    RenderSettings settings;
    settings.width = plan.width, settings.height = plan.height, settings.seed = plan.first_seed;
    settings.receiver = scene.receivers.front().ref;
    settings.schedule = Schedule::fused;
    FilmState half;
    {
        Renderer first(test_device(), scene, settings);
        first.render_passes(7);
        half = first.state();
    }
    settings.schedule = Schedule::wavefront;
    Renderer second(test_device(), scene, settings);
    second.restore(half);
    second.render_passes(9);
    const FilmState resumed = second.state();
    CHECK(same_bits(resumed, fused));
    CHECK(resumed.counters.rays == fused.counters.rays);
}
