// The image does not depend on how the work is divided: whole paths in one kernel or a kernel a stage, in one
// batch of passes or many, without or with a stop between.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/render/wavefront.h"
#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

// Of the surface class that the scenes have anyway: scattering by class compiles a kernel for each.
int emitter(SceneBuilder& scene, const nlohmann::json& radiance) {
    return scene.material({{"surface", {{"class", "lambertian"}, {"reflectance", 0.5}}},
                           {"emission", {{"radiance", radiance}}}});
}

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
    scene.rectangle(1, 1, emitter(scene, {4, 5, 6}),
                    Place{{0, 1.9, 0}, {0.70710678118654752, 0, 0, 0.70710678118654752}});
    scene.light({{"type", "point"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}}, at(1.2, 1.2, 1.2));
    scene.environment(0.1);
    scene.perspective(1.2, at(0, 0, 1.95));
    return scene;
}

// What forward rays have a path of their own for: a smooth sphere behind which vertices merge, straight
// passage, an absorbing medium, and two instances of a mesh.
SceneDescription caustic_scene() {
    SceneBuilder scene;
    scene.medium("glass", {{"ior", 1.5}, {"absorption", {0.2, 0.1, 0.4}}});
    const int white = scene.lambertian({0.7, 0.5, 0.3});
    add_box(scene, {4, 4, 4}, white, true, at(0, 0, 0));
    scene.sphere(0.6, scene.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                 at(-0.6, -0.6, 0));
    scene.rectangle(1.5, 1.5, scene.surface({{"class", "thin_dielectric"}}), at(0.3, 0, 1));
    scene.rectangle(0.5, 0.5, emitter(scene, {40, 50, 60}),
                    Place{{0, 1.9, 0}, {0.70710678118654752, 0, 0, 0.70710678118654752}});
    scene.light({{"type", "point"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}}, at(1.2, 1.2, 1.2));
    scene.perspective(1.2, at(0, 0, 1.95));
    // A rippled patch, of so many triangles that two of it are instances.
    constexpr uint32_t side = 130;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const float u = 1.5f * float(x) / (side - 1), v = 3.0f * float(y) / (side - 1);
            positions.push_back({u - 0.75f, 0.05f * std::sin(9 * u + 4 * v), v - 1.5f});
            const uint32_t i = y * side + x;
            if (x + 1 < side && y + 1 < side)
                for (const uint32_t k : {i, i + side, i + 1, i + 1, i + side, i + side + 1})
                    indices.push_back(k);
        }
    scene.mesh(positions, indices, white, at(-0.8, -1.7, 0));
    SceneDescription description = scene.import();
    MeshInstance second = description.instances.back();
    second.world_from_local = glm::translate(glm::dmat4(1), {1.6, 0.1, 0}) * second.world_from_local;
    description.instances.push_back(second);
    return description;
}

RenderSettings settings_for(const Scene& scene, Algorithm algorithm, uint32_t width, uint32_t height) {
    RenderSettings settings;
    settings.width = width, settings.height = height, settings.seed = 5;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = algorithm;
    return settings;
}

FilmState film_of(Scene& scene, RenderSettings settings, Schedule schedule,
                  const std::vector<uint32_t>& batches) {
    settings.schedule = schedule;
    Renderer renderer(test_device(), scene, settings);
    for (const uint32_t count : batches) renderer.render_passes(count);
    return renderer.state();
}

// Through the state of a film, as a checkpoint holds it, into a new renderer of another schedule.
FilmState film_resumed(Scene& scene, RenderSettings settings, Schedule before, uint32_t passes_before,
                       Schedule after, uint32_t passes_after) {
    const FilmState half = film_of(scene, settings, before, {passes_before});
    settings.schedule = after;
    Renderer renderer(test_device(), scene, settings);
    FilmState stored{half.pixels, half.passes, counters_from_json(to_json(half.counters)), half.bins};
    renderer.restore(stored);
    renderer.render_passes(passes_after);
    return renderer.state();
}

bool same_bits(const FilmState& a, const FilmState& b) {
    return a.passes == b.passes && a.pixels == b.pixels && a.bins == b.bins;
}

void check_same_counts(const RenderCounters& a, const RenderCounters& b) {
    CHECK(a.rays == b.rays);
    CHECK(a.shadow_rays == b.shadow_rays);
    CHECK(a.forward_paths == b.forward_paths);
    CHECK(a.forward_paths_a_pass == b.forward_paths_a_pass);
    CHECK(a.forward_rays == b.forward_rays);
    CHECK(a.forward_shadow_rays == b.forward_shadow_rays);
    // Summed in any order. What roulette takes is a small difference of large sums: rounding goes by these.
    const double scale = std::max(1.0, b.emitted);
    for (const auto& member : {&RenderCounters::escaped, &RenderCounters::emitted, &RenderCounters::absorbed,
                               &RenderCounters::roulette, &RenderCounters::forward_escaped})
        CHECK(a.*member == doctest::Approx(b.*member).epsilon(1e-6).scale(scale));
}

void check_schedules(Scene& scene, const RenderSettings& settings) {
    const FilmState fused = film_of(scene, settings, Schedule::fused, {8});
    CHECK(same_bits(fused, film_of(scene, settings, Schedule::fused, {1, 2, 5})));
    for (const Schedule schedule : {Schedule::wavefront, Schedule::by_class}) {
        INFO(schedule_name(schedule));
        const FilmState other = film_of(scene, settings, schedule, {3, 5});
        CHECK(same_bits(fused, other));
        check_same_counts(fused.counters, other.counters);
    }
    // The film holds something, and another seed gives other bits.
    RenderSettings reseeded = settings;
    reseeded.seed = 6;
    CHECK(!same_bits(fused, film_of(scene, reseeded, Schedule::fused, {8})));

    const FilmState resumed = film_resumed(scene, settings, Schedule::fused, 3, Schedule::wavefront, 5);
    CHECK(same_bits(fused, resumed));
    check_same_counts(fused.counters, resumed.counters);
}

}  // namespace

TEST_CASE("backward rays: schedules, batches and resumption give the same film, bit for bit") {
    Scene scene = compile_test_scene(varied_scene().import());
    check_schedules(scene, settings_for(scene, Algorithm::backward, 40, 24));
}

TEST_CASE("forward rays: schedules, batches and resumption give the same film, bit for bit") {
    Scene scene = compile_test_scene(caustic_scene());
    REQUIRE(scene.features.instances);
    const RenderSettings settings = settings_for(scene, Algorithm::forward, 40, 24);
    check_schedules(scene, settings);
    const FilmState film = film_of(scene, settings, Schedule::wavefront, {1});
    CHECK(film.counters.forward_rays > 2 * film.counters.forward_paths);
    CHECK(film.counters.forward_shadow_rays > film.counters.forward_paths);
    CHECK(film.counters.emitted == doctest::Approx(double(film.counters.forward_paths)).epsilon(0.1));
}

TEST_CASE("both directions: schedules, batches and resumption give the same film, bit for bit") {
    Scene scene = compile_test_scene(caustic_scene());
    RenderSettings settings = settings_for(scene, Algorithm::bidirectional, 40, 24);
    check_schedules(scene, settings);

    // Fewer forward paths where their vertices do not fit: all passes before the stop and after it have the
    // same.
    settings.vertex_bytes = 1500 * 124;
    check_schedules(scene, settings);
    const FilmState film = film_of(scene, settings, Schedule::wavefront, {2});
    CHECK(film.counters.forward_paths_a_pass < settings.width * settings.height);
}

TEST_CASE("light scattered in media: schedules, batches and resumption give the same film, bit for bit") {
    SceneBuilder s;
    s.medium("fog", {{"scattering", {0.2, 0.3, 0.4}}, {"phase", {{"class", "rayleigh"}}}});
    s.medium("milk", {{"ior", 1.4}, {"scattering", {4, 5, 6}}, {"absorption", 0.2}});
    add_box(s, {4, 4, 4},
            s.material({{"surface", {{"class", "lambertian"}, {"reflectance", {0.7, 0.5, 0.3}}}},
                        {"outside", "fog"}}),
            true, at(0, 0, 0));
    s.sphere(0.6,
             s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "milk"}, {"outside", "fog"}}),
             at(-0.6, -0.6, 0));
    s.light({{"type", "point"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}}, at(1.2, 1.2, 1.2));
    s.perspective(1.2, at(0, 0, 1.95));
    Scene scene = compile_test_scene(s.import());
    check_schedules(scene, settings_for(scene, Algorithm::bidirectional, 40, 24));
}

TEST_CASE("bodies with priorities: schedules, batches and resumption give the same film, bit for bit") {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.5, 0.1, 0.2}}});
    s.medium("ice", {{"ior", 1.31}, {"absorption", 0.2}});
    s.medium("ink", {{"absorption", {1, 2, 3}}});
    const auto body = [&](const nlohmann::json& surface, const char* inside, int priority) {
        return s.material({{"surface", surface}, {"inside", inside}, {"priority", priority}});
    };
    add_box(s, {4, 4, 4}, s.lambertian({0.7, 0.5, 0.3}), true, at(0, 0, 0));
    const int glass = body({{"class", "dielectric"}}, "glass", 3);
    add_box(s, {1.4f, 1.2f, 1.4f}, glass, false, at(-0.6, -0.8, 0));
    add_box(s, {1, 1, 1}, glass, true, at(-0.6, -0.8, 0));
    // What touches the glass, and what reaches into it, is of another class.
    add_box(s, {1, 1, 1}, body({{"class", "boundary"}}, "ink", 1), false, at(-0.6, -0.8, 0));
    s.sphere(0.5, body({{"class", "dielectric"}, {"alpha", 0.3}}, "ice", 2), at(0, -0.7, 0.3));
    s.light({{"type", "point"}, {"intensity", 2}, {"color", {1, 0.5, 0.25}}}, at(1.2, 1.2, 1.2));
    s.perspective(1.2, at(0, 0, 1.95));
    Scene scene = compile_test_scene(s.import());
    REQUIRE(scene.features.body_count == 3);
    check_schedules(scene, settings_for(scene, Algorithm::bidirectional, 40, 24));
}

TEST_CASE("more paths than the wavefront holds at once") {
    Scene scene = compile_test_scene(caustic_scene());
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        const RenderSettings settings = settings_for(scene, algorithm, 300, 250);
        REQUIRE(settings.width * settings.height > Wavefront::wanted_paths(test_device()));
        CHECK(same_bits(film_of(scene, settings, Schedule::fused, {1}),
                        film_of(scene, settings, Schedule::wavefront, {1})));
    }
}

TEST_CASE("the same seed gives the same film with forward rays, bit for bit") {
    Scene scene = compile_test_scene(caustic_scene());
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        RenderPlan plan;
        plan.width = 32, plan.height = 32, plan.first_seed = 5, plan.algorithm = algorithm;
        plan.vertex_bytes = 1 << 18;  // too little: passes shrink
        const FilmState first = render_film(scene, plan, Schedule::fused, {12});
        CHECK(same_bits(first, render_film(scene, plan, Schedule::fused, {1, 8, 3})));
        RenderPlan other = plan;
        other.first_seed = 6;
        CHECK(!same_bits(first, render_film(scene, other, Schedule::fused, {12})));

        // From another seed back to the first, and through the state of a film half way.
        RenderSettings settings = settings_for(scene, algorithm, plan.width, plan.height);
        settings.seed = 6;
        settings.vertex_bytes = plan.vertex_bytes;
        Renderer renderer(test_device(), scene, settings);
        renderer.render_passes(4);
        renderer.restart(5);
        renderer.render_passes(7);
        const FilmState half = renderer.state();
        settings.seed = 5;
        Renderer second(test_device(), scene, settings);
        second.restore(half);
        second.render_passes(5);
        const FilmState resumed = second.state();
        CHECK(same_bits(resumed, first));
        CHECK(resumed.counters.forward_paths == first.counters.forward_paths);
        CHECK(resumed.counters.forward_rays == first.counters.forward_rays);
    }
}
