// What --algorithm auto chooses, and that it renders what was chosen.
#include <doctest/doctest.h>

#include "host/render/automatic.h"
#include "host/render/techniques.h"
#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

// A matte floor, a sphere over it, and a lamp so small that no backward ray hits it by chance.
SceneBuilder lamp_over(const nlohmann::json& sphere_surface) {
    SceneBuilder scene;
    scene.medium("glass", {{"class", "homogeneous"}, {"ior", 1.5}});
    scene.rectangle(4, 4, scene.lambertian(0.6), {{0, 0, 0}, {-0.70710678, 0, 0, 0.70710678}});
    scene.sphere(0.5, scene.material({{"surface", sphere_surface}, {"inside", "glass"}}), at(0, 0.6, 0));
    scene.rectangle(0.05, 0.05, scene.black_emitter(1000), facing_down(0, 3, 0));
    scene.perspective(0.8, at(0, 1, 5));
    return scene;
}

RenderSettings automatic_settings(const Scene& scene) {
    RenderSettings settings;
    settings.width = settings.height = 32;
    settings.receiver = scene.receivers.front().ref;
    return settings;
}

// Without a renderer, which would compile its kernels.
AlgorithmChoice choice_for(const SceneDescription& description) {
    Scene scene = compile_test_scene(description);
    return choose_algorithm(test_device(), scene, automatic_settings(scene));
}

}  // namespace

TEST_CASE("automatic: matte surfaces need no forward rays") {
    const AlgorithmChoice choice =
        choice_for(lamp_over({{"class", "lambertian"}, {"reflectance", 0.5}}).import());
    CHECK(choice.algorithm == Algorithm::backward);
    CHECK(choice.reason == "no surface is smooth or nearly so");
    CHECK(choice.pilot_seconds == 0);
}

// Points of the fog near the light are met by chance: with backward rays the variance has no bound, as the
// square of what a point receives falls with the fourth power of the distance.
TEST_CASE("automatic: a point light in fog is brought by forward rays") {
    SceneBuilder scene;
    scene.medium("fog", {{"class", "homogeneous"}, {"scattering", 0.3}});
    const nlohmann::json boundary = {{"surface", {{"class", "boundary"}}}, {"inside", "fog"}};
    scene.sphere(2, scene.material(boundary), at(0, 0, 0));
    scene.light({{"type", "point"}, {"intensity", 10}}, at(0.2, 0.1, 0));
    scene.perspective(0.8, at(0, 0, 5));
    const AlgorithmChoice choice = choice_for(scene.import());
    CHECK(choice.algorithm == Algorithm::bidirectional);
    CHECK(choice.pilot_seconds > 0);
}

TEST_CASE("automatic: light that forward rays alone bring is traced both ways, without a pilot") {
    for (const double divergence : {0.0, 0.1}) {
        SceneBuilder scene = lamp_over({{"class", "lambertian"}, {"reflectance", 0.5}});
        scene.placed("light", {{"class", "collimated"}, {"divergence", divergence}}, facing_down(0, 2, 0));
        scene.document["nodes"].back()["name"] = "laser";
        const AlgorithmChoice choice = choice_for(scene.import());
        CHECK(choice.algorithm == (divergence > 0 ? Algorithm::backward : Algorithm::bidirectional));
        if (divergence == 0) CHECK(choice.reason == "forward rays alone bring the light of laser");
        CHECK(choice.pilot_seconds == 0);
    }
}

TEST_CASE("automatic: a lamp over a cloud needs no pilot") {
    SceneBuilder scene;
    scene.medium("fog", {{"class", "homogeneous"}, {"scattering", 0.3}});
    const nlohmann::json boundary = {{"surface", {{"class", "boundary"}}}, {"inside", "fog"}};
    scene.sphere(2, scene.material(boundary), at(0, 0, 0));
    scene.rectangle(0.5, 0.5, scene.black_emitter(10), facing_down(0, 3, 0));
    scene.perspective(0.8, at(0, 0, 5));
    CHECK(choice_for(scene.import()).pilot_seconds == 0);
}

TEST_CASE("automatic: light from everywhere needs no forward rays") {
    SceneBuilder scene;
    scene.medium("glass", {{"class", "homogeneous"}, {"ior", 1.5}});
    scene.sphere(0.5, scene.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                 at(0, 0, 0));
    scene.environment(1.0);
    scene.perspective(0.8, at(0, 0, 3));
    const AlgorithmChoice choice = choice_for(scene.import());
    CHECK(choice.algorithm == Algorithm::backward);
    CHECK(choice.reason == "no light is compact");
}

TEST_CASE("automatic: a beam that few points are lit by is compact") {
    SceneBuilder scene;
    scene.rectangle(4, 4, scene.lambertian(0.6), at(0, 0, 0));
    scene.environment(0.01);
    scene.light({{"type", "spot"}, {"intensity", 1e6}, {"spot", {{"outerConeAngle", 0.005}}}}, at(0, 0, 2));
    scene.perspective(0.8, at(0, 0, 3));
    Scene compiled = compile_test_scene(scene.import());
    CHECK(find_compact_lights(test_device(), compiled).any);
    CHECK(find_compact_lights(test_device(), compiled).points);
}

TEST_CASE("automatic: without light there is nothing to trace forward") {
    SceneBuilder scene;
    scene.sphere(0.5, scene.surface({{"class", "conductor"}}), at(0, 0, 0));
    scene.perspective(0.8, at(0, 0, 3));
    CHECK(choice_for(scene.import()).reason == "no light");
}

TEST_CASE("automatic: a small lamp through glass is brought by forward rays") {
    Scene scene = compile_test_scene(lamp_over({{"class", "dielectric"}}).import());
    const AlgorithmChoice choice = Renderer(test_device(), scene, automatic_settings(scene)).choice();
    CHECK(choice.algorithm == Algorithm::bidirectional);
    CHECK(choice.forward_paths >= 0.25);
    CHECK(choice.forward_paths <= 16);
    CHECK(choice.pilot_seconds > 0);
}

// The number of forward paths changes the noise, not the image.
TEST_CASE("automatic: the mean does not depend on the number of forward paths") {
    Scene scene = compile_test_scene(lamp_over({{"class", "dielectric"}}).import());
    RenderPlan plan;
    plan.width = plan.height = 24;
    plan.passes = 128;
    plan.seeds = 8;
    plan.algorithm = Algorithm::bidirectional;
    plan.forward_paths = 0.5;
    const WindowMean few = window_mean(render_estimates(scene, plan));
    plan.forward_paths = 4;
    const WindowMean many = window_mean(render_estimates(scene, plan));
    const double sd = std::hypot(few.standard_error, many.standard_error);
    CHECK(std::abs(few.mean - many.mean) < 4 * sd + 0.002 * many.mean);
}
