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
