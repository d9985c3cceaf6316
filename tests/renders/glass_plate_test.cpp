// Light in blocks and plates of glass, against closed forms: what is trapped, what leaves at the first hit,
// how long the way through is, and how far a plate shifts a ray.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/render/path_record.h"
#include "tests/support/render_probe.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi, ior = 1.49, half_turn = 0.70710678118654752;

RenderSettings forward_settings(const Scene& scene, uint32_t seed, double paths) {
    RenderSettings settings;
    settings.width = settings.height = 4;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = Algorithm::forward;
    settings.forward_paths = paths / 16;
    settings.seed = seed;
    return settings;
}

// Of the emitted flux, over 16 seeds.
Moments share_of(Scene& scene, double (*share)(const RenderCounters&), double paths) {
    Moments shares;
    for (uint32_t seed = 1; seed <= 16; ++seed) {
        Renderer renderer(test_device(), scene, forward_settings(scene, seed, paths / 16));
        renderer.render_passes(1);
        shares.add(share(renderer.counters()) / renderer.counters().emitted);
    }
    return shares;
}

void check_share(const Moments& shares, double expected) {
    MESSAGE(shares.mean, " +- ", shares.standard_error(), ", expected ", expected);
    CHECK(std::fabs(shares.mean - expected) < 3 * shares.standard_error() + 2e-5 * expected);
    CHECK(shares.standard_error() < 2e-3 * expected);
}

// A plate in the plane y = 0, open at its sides far away; `bottom`: the material of its lower face, else
// glass.
SceneBuilder plate(double size, double thickness, const nlohmann::json& medium,
                   const char* bottom = "dielectric") {
    SceneBuilder s;
    s.medium("glass", medium);
    const auto face = [&](const char* name) {
        return s.material({{"surface", {{"class", name}}}, {"inside", "glass"}});
    };
    s.rectangle(float(size), float(size), face("dielectric"),
                {{0, 0.5 * thickness, 0}, {-half_turn, 0, 0, half_turn}});
    s.rectangle(float(size), float(size), face(bottom),
                {{0, -0.5 * thickness, 0}, {half_turn, 0, 0, half_turn}});
    s.perspective(1, at(0, 5, 0));
    return s;
}

}  // namespace

// Beyond the critical angle from all three pairs of faces: 3 cos - 2 of all directions. A faint absorption
// ends what is trapped, and takes 0.2 % at most of what is not.
TEST_CASE("a block of glass traps what is beyond the critical angle of all its faces") {
    SceneBuilder s;
    s.medium("glass", {{"ior", ior}, {"absorption", 2e-3}});
    add_box(s, {1, 1.3f, 0.8f}, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
            false, at(0, 0, 0));
    s.light({{"type", "point"}, {"intensity", 1}}, at(0.1, -0.2, 0.05));
    s.perspective(1, at(0, 5, 0));
    Scene scene = compile_test_scene(s.import());
    const Moments shares = share_of(
        scene, [](const RenderCounters& c) { return c.forward_escaped; }, 1 << 16);
    const double trapped = 3 * std::sqrt(1 - 1 / (ior * ior)) - 2;
    CHECK(trapped == doctest::Approx(.2239893).epsilon(1e-6));
    MESSAGE(shares.mean, " +- ", shares.standard_error());
    CHECK(std::fabs(shares.mean - (1 - trapped)) < 3 * shares.standard_error() + 2e-3);
    CHECK(shares.standard_error() < 2e-3);
}

// Up and out through the upper face at once, or never: below all is absorbed. Half of what both faces let out
// at a first hit.
TEST_CASE("what leaves glass at the first hit of a face is what Fresnel's equations let through") {
    SceneBuilder s = plate(8000, 0.1, {{"ior", ior}}, "absorber");
    s.light({{"type", "point"}, {"intensity", 1}}, at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    check_share(share_of(
                    scene, [](const RenderCounters& c) { return c.forward_escaped; }, 1 << 20),
                0.5 * .2336496);
}

// Lambert's cosine of the light is that of a lamp without a body, so nothing but glass takes anything. A
// faint absorption a takes a times the mean way, of all that is incident 2 n² (1 - cos of the critical angle)
// times the thickness, whatever is reflected.
TEST_CASE("the mean way of diffuse light through a plate of glass") {
    constexpr double thickness = 0.01, absorption = 0.02;
    SceneBuilder s = plate(1000, thickness, {{"ior", ior}, {"absorption", absorption}});
    s.placed("light",
             {{"class", "ies"},
              {"file", source_path("tests/host/photometry/own_lambert_iesna91_one_per_line.ies")},
              {"point", true}},
             {{0, 1, 0}, {-half_turn, 0, 0, half_turn}});
    Scene scene = compile_test_scene(s.import());
    const Moments shares = share_of(
        scene, [](const RenderCounters& c) { return c.absorbed / (thickness * absorption); }, 1 << 20);
    const double expected = 2 * ior * ior * (1 - std::sqrt(1 - 1 / (ior * ior)));
    CHECK(expected == doctest::Approx(1.1485475));
    // The file's steps of 5 degrees are no exact cosine; ways weaken by 2e-4.
    MESSAGE(shares.mean, " +- ", shares.standard_error());
    CHECK(std::fabs(shares.mean - expected) < 3 * shares.standard_error() + 1.5e-3 * expected);
    CHECK(shares.standard_error() < 1e-3 * expected);
}

TEST_CASE("a plate of 6 mm shifts a ray at 45 degrees by 2.0130046 mm") {
    SceneBuilder s = plate(1, 0.006, {{"ior", 1.52}});
    const double a = pi / 8;  // half of 45 degrees, about z from straight down
    s.placed("light", {{"class", "collimated"}, {"radius", 1e-3}},
             {{0.1, 0.1, 0},
              {-half_turn * std::cos(a), -half_turn * std::sin(a), half_turn * std::sin(a),
               half_turn * std::cos(a)}});
    Scene scene = compile_test_scene(s.import());
    PathRecorder recorder(test_device(), scene, forward_settings(scene, 1, 256), true);
    std::vector<uint32_t> all(recorder.paths_a_pass());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    int straight_through = 0;
    for (const RecordedPath& path : recorder.record(0, all)) {
        const auto& v = path.vertices;
        if (v.size() < 4 || v[1].event != PathEvent::refracted || v[2].event != PathEvent::refracted)
            continue;
        ++straight_through;
        const glm::dvec3 in = glm::normalize(v[1].position - v[0].position),
                         out = glm::normalize(v[3].position - v[2].position);
        CHECK(in.y == doctest::Approx(-half_turn).epsilon(1e-5));
        CHECK(glm::length(in - out) < 1e-5);
        const glm::dvec3 aside = v[2].position - v[0].position;
        CHECK(glm::length(aside - glm::dot(aside, in) * in) == doctest::Approx(2.0130046e-3).epsilon(1e-4));
    }
    CHECK(straight_through > 200);
}
