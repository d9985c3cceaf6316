// What each material and medium has absorbed of forward rays: shares that a closed form knows, and sums that
// leave nothing out.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "host/gltf/gltf.h"
#include "host/measure/report.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/support/render_probe.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

RenderCounters count(Scene& scene, Algorithm algorithm, Schedule schedule, uint32_t passes, double paths) {
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = algorithm, settings.schedule = schedule;
    settings.forward_paths = paths;
    settings.ledger = true;
    Renderer renderer(test_device(), scene, settings);
    renderer.render_passes(passes);
    return renderer.counters();
}

double told(const RenderCounters& counters) {
    return std::accumulate(counters.absorbed_by.begin(), counters.absorbed_by.end(), 0.0,
                           [](double sum, const auto& entry) { return sum + entry.second; });
}

}  // namespace

// A point in the middle of a black cube, within a ball that absorbs.
TEST_CASE("a sixth of the light ends at each wall, what a medium on the way leaves of it") {
    SceneBuilder s;
    const double absorption = 1.2, radius = 0.5, left = std::exp(-absorption * radius);
    s.medium("ink", {{"absorption", absorption}});
    const auto black = [&](const char* name) {
        return s.material({{"surface", {{"class", "absorber"}}}}, {{"name", name}});
    };
    s.sphere(radius,
             s.material({{"surface", {{"class", "boundary"}}}, {"inside", "ink"}}, {{"name", "skin"}}),
             at(0, 0, 0));
    add_box(s, {2, 2, 2}, black("walls"), true, at(0, 0, 0));
    s.rectangle(1.99, 1.99, black("floor"), at(0, 0, -0.995));  // in front of the sixth wall
    s.light({{"type", "point"}, {"intensity", 2}}, at(0, 0, 0));
    s.orthographic(0.5, at(0, 0, 0.9));
    Scene scene = compile_test_scene(s.import());
    for (const Schedule schedule : {Schedule::fused, Schedule::wavefront}) {
        const RenderCounters c = count(scene, Algorithm::forward, schedule, 16, 16);
        const double n = c.emitted;
        CHECK(c.absorbed_by.at("medium ink") == doctest::Approx((1 - left) * n).epsilon(1e-4));
        CHECK(c.absorbed_by.at("material floor") == doctest::Approx(left * n / 6).epsilon(0.01));
        CHECK(c.absorbed_by.at("material walls") == doctest::Approx(left * n * 5 / 6).epsilon(0.01));
        CHECK(!c.absorbed_by.contains("material skin"));
        CHECK(told(c) == doctest::Approx(n).epsilon(1e-6));
    }
}

TEST_CASE("what materials and media have absorbed is all that was absorbed") {
    for (const char* name : {"glass_in_fog", "caustic_box", "prism"}) {
        CAPTURE(std::string(name));
        Scene scene = compile_test_scene(import_gltf(source_path("scenes/" + std::string(name) + ".gltf")));
        for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
            const RenderCounters c = count(scene, algorithm, Schedule::fused, 8, 4);
            CHECK(c.absorbed > 0);
            CHECK(c.absorbed_by.size() >= 2);
            CHECK(std::fabs(told(c) - c.absorbed) < 1e-6 * c.emitted);
            CHECK(std::fabs(c.emitted - told(c) - c.forward_escaped - c.forward_depth_limit_lost -
                            c.roulette) < 2e-6 * c.emitted);
        }
    }
}

// A lamp of 100 lm before a plate of grey glass in an element, which also holds a lamp of its own.
TEST_CASE("elements tell what entered and left them and what they absorbed") {
    for (const bool shines : {false, true}) {
        SceneBuilder s;
        s.medium("grey glass", {{"ior", 1.5}, {"absorption", 20}});
        const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "grey glass"}});
        const int lamp = s.black_emitter(50);
        const int inner = s.scene([&] {
            add_box(s, {1, 1, 0.01f}, glass, false, at(0, 0, 0));
            if (shines) s.sphere(0.1, lamp, at(0.4, 0, 0.5));
        });
        s.placed("element", {{"class", "subscene"}, {"scene", inner}}, at(0, 0, 0));
        s.document["nodes"].back()["name"] = "pane";
        s.placed("light", {{"class", "collimated"}, {"radius", 0.1}, {"power", 100}}, at(0, 0, 2));
        s.perspective(1, at(0, 0, 5));
        Scene scene = compile_test_scene(s.import());
        const RenderCounters c = count(scene, Algorithm::forward, Schedule::automatic, 8, 16);
        const ElementPower power = c.elements.at("pane");
        CHECK(power.absorbed >= c.absorbed_by.at("medium grey glass"));
        const double emitted =
            c.emitted - c.forward_escaped - c.absorbed - c.roulette - c.forward_depth_limit_lost;
        CHECK(std::fabs(emitted) < 2e-6 * c.emitted);
        if (shines) {
            const double of_lamp = 4 * M_PI * 0.1 * 0.1 * M_PI * 50 / scene.power * c.emitted;
            CHECK(power.entered + of_lamp - power.left == doctest::Approx(power.absorbed).epsilon(0.02));
        } else {
            // All light enters; what is not absorbed leaves.
            CHECK(power.entered == doctest::Approx(c.emitted).epsilon(1e-6));
            CHECK(power.left == doctest::Approx(c.forward_escaped).epsilon(1e-6));
            CHECK(power.absorbed == doctest::Approx(c.absorbed).epsilon(1e-6));
        }
    }
}
