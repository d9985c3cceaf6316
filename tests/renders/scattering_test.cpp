// Media that scatter, against closed forms: single scattering in a slab, lossless media in a furnace, and a
// half space that light enters a thousand times deeper than it sees.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "host/scene/spectral_value.h"
#include "host/spectra/color.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/sphere_row.h"
#include "tests/support/phase_cases.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

int filled(SceneBuilder& s, const json& surface, const char* inside) {
    return s.material({{"surface", surface}, {"inside", inside}});
}
const json boundary = {{"class", "boundary"}};

std::vector<PhaseCase> phases() {
    return {isotropic_phase(), rayleigh_phase(), lobe_phase(0.6), lobe_phase(-0.3)};
}

// So little scatters that what does so twice is below 1e-4 of what does so once.
constexpr double scattered[3] = {1e-4, 2e-4, 0.5e-4}, absorbed[3] = {1, 0.5, 2}, sun = 3;

Estimates render_slab(const json& phase, bool grazing, Algorithm algorithm,
                      const json& scattering = scattered, const json& absorption = absorbed) {
    SceneBuilder s;
    s.medium("haze", {{"scattering", scattering}, {"absorption", absorption}, {"phase", phase}});
    // Its upper side is z = 0; light falls in at 30 degrees, or along +x through the side x = -1.
    add_box(s, {grazing ? 2.f : 5.f, grazing ? 2.f : 4.f, 1}, filled(s, boundary, "haze"), false,
            at(0, 0, -0.5));
    const double turned = grazing ? -pi / 2 : -pi / 6;
    s.light({{"type", "directional"}, {"intensity", sun}},
            {{0, 0, 0}, {0, std::sin(turned / 2), 0, std::cos(turned / 2)}});
    s.orthographic(0.5, at(0, 0, 2));
    RenderPlan plan;
    plan.width = plan.height = 16, plan.seeds = 8, plan.algorithm = algorithm;
    plan.passes = algorithm == Algorithm::backward ? 256 : 64;
    plan.forward_paths = algorithm == Algorithm::forward ? 64 : 4;  // few meet what the camera sees
    return render_estimates(s.import(), plan);
}

double slab_radiance(const PhaseCase& phase, bool grazing, double scattering, double absorption) {
    const double extinction = scattering + absorption;
    if (grazing) {  // the mean over x in [-0.5, 0.5] of exp(-extinction (x + 1))
        const double light = (std::exp(-0.5 * extinction) - std::exp(-1.5 * extinction)) / extinction;
        return sun * phase.value(0) * scattering * light * (1 - std::exp(-extinction)) / extinction;
    }
    const double cosine = std::cos(pi / 6), both = extinction * (1 + 1 / cosine);
    return sun * phase.value(-cosine) * scattering * (1 - std::exp(-both)) / both;
}
double slab_radiance(const PhaseCase& phase, bool grazing, int c) {
    return slab_radiance(phase, grazing, scattered[c], absorbed[c]);
}

}  // namespace

TEST_CASE("single scattering in a slab is as bright as its integral, for every phase function and channel") {
    for (const PhaseCase& phase : phases())
        for (const bool grazing : {false, true}) {
            if (grazing && phase.record["class"] == "rayleigh") continue;  // one kernel less
            const Estimates e = render_slab(phase.record, grazing, Algorithm::backward);
            for (int c = 0; c < 3; ++c) {
                const WindowMean m = window_mean(e, {}, c);
                const double expected = slab_radiance(phase, grazing, c);
                CAPTURE(phase.record.dump());
                CAPTURE(grazing);
                CAPTURE(c);
                CAPTURE(m.mean);
                CHECK(std::fabs(m.mean - expected) < 5e-4 * expected + 4 * m.standard_error);
                CHECK(m.standard_error < 5e-3 * expected);
            }
        }
}

TEST_CASE("single scattering in a slab has the colour that its integral has over the wavelengths") {
    const auto table = [](double at_400, double at_550, double at_700) {
        return json{{"wavelengths", {400, 550, 700}}, {"values", {at_400, at_550, at_700}}};
    };
    const auto factor = [](const json& value) {
        return spectral_value(value, {}, "/test", SpectralKind::factor).as_table(SpectralKind::factor);
    };
    const json scattering = table(3e-4, 1e-4, 0.2e-4), absorption = table(0.3, 1, 4);
    const SpectralTable s = factor(scattering), a = factor(absorption);
    const PhaseCase phase = phases()[2];
    const glm::dvec3 expected = rgb_of_radiance(
        white_light() * tabulate([&](double nm) { return slab_radiance(phase, false, s.at(nm), a.at(nm)); }));
    const Estimates e = render_slab(phase.record, false, Algorithm::backward, scattering, absorption);
    const double y = glm::dot(expected, glm::dvec3(0.2126, 0.7152, 0.0722));
    for (int c = 0; c < 3; ++c) {
        const WindowMean m = window_mean(e, {}, c);
        CAPTURE(c);
        CAPTURE(m.mean / y);
        CAPTURE(expected[c] / y);
        CHECK(std::fabs(m.mean - expected[c]) < 2e-3 * y + 4 * m.standard_error);
        CHECK(m.standard_error < 0.01 * y);
    }
}

TEST_CASE("single scattering in a slab, by forward rays and by both") {
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        const PhaseCase phase = phases()[2];
        const Estimates e = render_slab(phase.record, false, algorithm);
        for (int c = 0; c < 3; ++c) {
            const WindowMean m = window_mean(e, {}, c);
            const double expected = slab_radiance(phase, false, c);
            CAPTURE(algorithm_name(algorithm));
            CAPTURE(c);
            CAPTURE(m.mean);
            CHECK(std::fabs(m.mean - expected) < 5e-4 * expected + 4 * m.standard_error);
            CHECK(m.standard_error < 0.01 * expected);
        }
    }
}

TEST_CASE("single scattering that only merging brings: lit by a mirror and seen in another") {
    // The slab of above. The camera looks along -x at a mirror that shows the slab from above; light falls on
    // it from a mirror that stands upright at x = -2.2, and straight from the sky only beside what is seen.
    const PhaseCase phase = phases()[2];
    SceneBuilder s;
    s.medium("haze", {{"scattering", scattered}, {"absorption", absorbed}, {"phase", phase.record}});
    add_box(s, {4, 4, 1}, filled(s, boundary, "haze"), false, at(0, 0, -0.5));
    const int mirror = s.surface({{"class", "conductor"}, {"reflectance", 1}});
    const auto tilted = [](double degrees, const glm::dvec3& position) {
        const double a = degrees * pi / 360;
        return Place{position, {0, std::sin(a), 0, std::cos(a)}};
    };
    s.rectangle(1.6, 1.1, mirror, tilted(135, {0, 0, 4}));
    s.orthographic(0.5, tilted(90, {2, 0, 4}));
    s.rectangle(3.8, 2, mirror, tilted(90, {-2.2, 0, 3.3}));
    s.rectangle(2, 3, s.surface({{"class", "absorber"}}), at(2, 0, 2.9));
    s.light({{"type", "directional"}, {"intensity", sun}}, tilted(30, {0, 0, 0}));
    RenderPlan plan;
    plan.width = plan.height = 16, plan.seeds = 8, plan.algorithm = Algorithm::bidirectional;
    plan.passes = 32, plan.forward_paths = 128, plan.merge_radius = 1.5f;
    const Estimates e = render_estimates(s.import(), plan);
    for (int c = 0; c < 3; ++c) {
        const WindowMean m = window_mean(e, {}, c);
        const double expected = slab_radiance(phase, false, c);
        CAPTURE(c);
        CAPTURE(m.mean);
        CAPTURE(expected);
        MESSAGE("off by ", 100 * (m.mean / expected - 1), " % +- ", 100 * m.standard_error / expected);
        // Rays pass the slab upright, so that no disk around a vertex reaches out of it.
        CHECK(std::fabs(m.mean / expected - 1) < 1e-3 + 4 * m.standard_error / expected);
        CHECK(m.standard_error < 0.02 * expected);
    }
}

namespace {

struct Ball {
    const char* name;
    json surface, medium;
    double tolerance = 0.001;  // relative, besides four standard errors
};

std::vector<Ball> lossless_balls() {
    const auto lobe = [](double g, json scattering) {
        return json{{"scattering", scattering}, {"phase", {{"class", "henyey_greenstein"}, {"g", g}}}};
    };
    const json glass = {{"class", "dielectric"}},
               rough = {{"class", "dielectric"}, {"alpha", 0.3}, {"multiscatter", true}};
    json milk = lobe(0.5, 2);
    milk["ior"] = 1.5;
    return {{"isotropic", boundary, {{"scattering", 3}}},
            {"g 0.5", boundary, lobe(0.5, 3)},
            {"g -0.5", boundary, lobe(-0.5, 3)},
            {"g 0.99", boundary, lobe(0.99, 10)},
            {"g -0.99", boundary, lobe(-0.99, 3)},
            {"coloured", boundary, lobe(0.3, {0.3, 3, 12})},
            {"thin", boundary, {{"scattering", 1e-6}}},
            {"in smooth glass", glass, milk},
            {"in rough glass", rough, milk, 0.005},
            {"Rayleigh", boundary, {{"scattering", {1, 2, 4}}, {"phase", {{"class", "rayleigh"}}}}}};
}

const double sky[3] = {0.5, 1, 2};

}  // namespace

TEST_CASE("lossless media are invisible under a constant environment") {
    const std::vector<Ball> balls = lossless_balls();
    SceneBuilder s;
    for (size_t i = 0; i < balls.size(); ++i) {
        s.medium(balls[i].name, balls[i].medium);
        s.sphere(1, filled(s, balls[i].surface, balls[i].name), at(sphere_spacing * (double(i) + 0.5), 0, 0));
    }
    s.environment({sky[0], sky[1], sky[2]});
    s.orthographic(1.1, at(1.1 * double(balls.size()), 0, 5));
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
        RenderPlan plan;
        plan.width = sphere_pixels * uint32_t(balls.size()), plan.height = sphere_pixels,
        plan.algorithm = algorithm;
        plan.passes = algorithm == Algorithm::backward ? 128 : 32;
        const Estimates e = render_estimates(scene, plan);
        for (size_t i = 0; i < balls.size(); ++i) {
            const WindowMean m = disk_albedo(e, i, 0.95, sky);
            CAPTURE(algorithm_name(algorithm));
            CAPTURE(balls[i].name);
            CAPTURE(m.mean);
            CAPTURE(m.standard_error);
            CHECK(std::fabs(m.mean - 1) < balls[i].tolerance + 4 * m.standard_error);
            CHECK(m.standard_error < (algorithm == Algorithm::backward ? 0.005 : 0.008));
        }
        CHECK(e.counters.depth_limit == 0);
        CHECK(e.counters.non_finite == 0);
        CHECK(e.counters.forward_non_finite == 0);
    }
}

TEST_CASE("a thick ball of albedo 0.9999 reflects as a half space does") {
    // Radiance that leaves a half space under a constant sky, relative to it: 1 - sqrt(1 - albedo) H(mu)
    // (Chandrasekhar 1950, sections 37 and 38), with H of isotropic scattering by iteration.
    constexpr double albedo = 0.9999, coefficient = 1e4;
    constexpr int n = 400;
    const double root = std::sqrt(1 - albedo);
    std::vector<double> h(n, 1.0), next(n);
    const auto mu = [](int i) { return (i + 0.5) / n; };
    for (int round = 0; round < 2000; ++round) {
        for (int i = 0; i < n; ++i) {
            double sum = 0;
            for (int k = 0; k < n; ++k) sum += mu(k) * h[size_t(k)] / (mu(i) + mu(k)) / n;
            next[size_t(i)] = 1 / (root + 0.5 * albedo * sum);
        }
        double change = 0;
        for (int i = 0; i < n; ++i) change = std::max(change, std::fabs(next[size_t(i)] - h[size_t(i)]));
        h = next;
        if (change < 1e-7) break;
    }
    double expected = 0, weight = 0;
    for (int i = 0; i < n; ++i) {
        if (std::sqrt(1 - mu(i) * mu(i)) > 0.9) continue;  // the camera sees the middle of the disk
        expected += mu(i) * (1 - root * h[size_t(i)]), weight += mu(i);
    }
    expected /= weight;
    SceneBuilder s;
    s.medium("snow", {{"scattering", albedo * coefficient}, {"absorption", (1 - albedo) * coefficient}});
    s.sphere(1, filled(s, boundary, "snow"), at(0, 0, 0));
    s.environment({sky[0], sky[1], sky[2]});
    s.orthographic(0.9 / std::sqrt(2.0), at(0, 0, 5));
    RenderPlan plan;
    plan.width = plan.height = 8, plan.passes = 64;
    const Estimates e = render_estimates(s.import(), plan);
    MESSAGE(expected);
    CHECK(e.counters.depth_limit == 0);
    CHECK(e.counters.non_finite == 0);
    for (int c = 0; c < 3; ++c) {
        const WindowMean m = window_mean(e, {}, c);
        CAPTURE(m.mean / sky[c]);
        CAPTURE(m.standard_error / sky[c]);
        CHECK(std::fabs(m.mean / sky[c] - expected) < 0.003 + 4 * m.standard_error / sky[c]);
    }
}

namespace {

// A room full of coloured fog that camera and lamps stand in, with a cloud, milk in rough glass and a solid.
// With `clear_view` the air is clear right before the camera: what scatters there is far too bright by
// forward rays alone (1 / distance² has no variance in space), though right in the mean.
SceneBuilder foggy_room(bool clear_view) {
    SceneBuilder s;
    s.medium("fog", {{"scattering", {0.1, 0.2, 0.35}},
                     {"absorption", {0.02, 0.05, 0.03}},
                     {"phase", {{"class", "henyey_greenstein"}, {"g", 0.5}}}});
    s.medium("cloud", {{"scattering", {3, 2, 1}}, {"absorption", 0.1}, {"phase", {{"class", "rayleigh"}}}});
    s.medium("milk", {{"ior", 1.4},
                      {"scattering", {4, 5, 6}},
                      {"absorption", {0.1, 0.2, 0.4}},
                      {"phase", {{"class", "henyey_greenstein"}, {"g", 0.8}}}});
    const auto between = [&](const json& surface, const char* inside) {
        return s.material({{"surface", surface}, {"inside", inside}, {"outside", "fog"}});
    };
    add_box(s, {4, 4, 4},
            s.material({{"surface", {{"class", "lambertian"}, {"reflectance", {0.7, 0.5, 0.3}}}},
                        {"outside", "fog"}}),
            true, at(0, 0, 0));
    s.perspective(1.2, at(0, 0, 1.6));
    if (clear_view) s.sphere(0.35, s.material({{"surface", boundary}, {"outside", "fog"}}), at(0, 0, 1.6));
    add_lamp(s, 1.2);
    s.sphere(0.6, between(boundary, "cloud"), at(-0.9, -0.9, 0.2));
    s.sphere(0.5, between({{"class", "dielectric"}, {"alpha", 0.4}}, "milk"), at(1, -1.3, 0.1));
    add_box(s, {0.8f, 1.2f, 0.8f}, s.lambertian(0.6), false, at(0.1, -1.4, -1));
    return s;
}

}  // namespace

TEST_CASE("algorithms agree: a room of coloured fog, with a cloud and milk in rough glass") {
    Comparison c;
    c.backward = 128, c.forward = 0, c.bidirectional = 32;
    check_against_backward(foggy_room(false), c);
}

TEST_CASE("algorithms agree: fog, cloud and milk seen through clear air" * doctest::test_suite("long")) {
    Comparison c;
    c.forward = 256;
    check_against_backward(foggy_room(true), c);
}

TEST_CASE("algorithms agree: milk in smooth glass, fog before a mirror" * doctest::test_suite("long")) {
    SceneBuilder s = foggy_room(true);
    s.sphere(0.35,
             s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "milk"}, {"outside", "fog"}}),
             at(0, -0.5, 0.6));
    s.sphere(0.4, s.surface(metal(0)), at(-1.2, 0.4, -0.8));
    Comparison c;
    c.backward = 512, c.forward = 256;
    check_against_backward(s, c);
}

// Backward rays alone do not do here: the light that they sample from points around a point light goes with
// 1 / distance² and has no variance in space.
TEST_CASE("forward and bidirectional rays agree: ink around a point light, in fog" *
          doctest::test_suite("long")) {
    SceneBuilder s = foggy_room(true);
    s.medium("ink", {{"scattering", {1, 2, 3}}, {"absorption", {2, 1, 0.5}}});
    s.sphere(0.4, s.material({{"surface", boundary}, {"inside", "ink"}, {"outside", "fog"}}),
             at(1, 0.6, 0.3));
    s.light({{"type", "point"}, {"intensity", 1}}, at(1, 0.6, 0.3));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.merge_radius = 0.1f;
    plan.algorithm = Algorithm::forward, plan.passes = 256, plan.first_seed = 1001;
    const Estimates expected = render_estimates(scene, plan);
    plan.algorithm = Algorithm::bidirectional, plan.passes = 64, plan.first_seed = 2001;
    check_agreement("bidirectional", render_estimates(scene, plan), expected);
}
