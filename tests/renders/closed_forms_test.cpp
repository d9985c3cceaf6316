// Slabs, guides, layers of dots and cameras against closed forms, each value computed on its own in double
// precision.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"
#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

int glass(SceneBuilder& s, double ior, const char* surface = "dielectric") {
    s.medium("glass", {{"ior", ior}});
    return s.material({{"surface", {{"class", surface}}}, {"inside", "glass"}});
}

// The flux that a meter gets forward, of a lamp of 1 lm.
WindowMean flux(const SceneBuilder& s, double area, double paths = 20000) {
    SceneOptions options = test_options();
    options.polarization = PolarizationMode::on;
    Scene scene = compile_test_scene(s.import(), options);
    RenderPlan plan;
    plan.width = plan.height = 1, plan.algorithm = Algorithm::forward, plan.forward_paths = paths;
    plan.passes = 1, plan.seeds = 16;
    WindowMean mean = window_mean(render_estimates(scene, plan));
    mean.mean *= area, mean.standard_error *= area;
    return mean;
}

void check(const WindowMean& found, double expected, double largest_error = 0.002) {
    MESSAGE(found.mean, " +- ", found.standard_error, ", expected ", expected);
    CHECK(found.standard_error < largest_error * expected);
    CHECK(std::abs(found.mean - expected) < 4 * found.standard_error + 1e-6);
}

json meter(double size) { return {{"class", "illuminance"}, {"size", {size, size}}, {"resolution", {1, 1}}}; }

}  // namespace

// All reflections between both faces, of s and p apart: light is polarized on its way between them.
TEST_CASE("a slab lets through what Fresnel's equations say") {
    for (const auto& [ior, degrees, expected] : {std::tuple{1.49, 0, .925437},
                                                 {1.49, 60, .850503},
                                                 {1.49, 75, .619931},
                                                 {1.52, 45, .902528},
                                                 {1.52, 80, .456043}}) {
        CAPTURE(ior);
        CAPTURE(degrees);
        SceneBuilder s;
        add_box(s, {4, 4, 0.01f}, glass(s, ior), false, at(0, 0, 0));
        const double a = degrees * pi / 180;
        s.placed("light", {{"class", "collimated"}, {"radius", 0.01}, {"power", 1}},
                 {{-0.3 * std::sin(a), 0, 0.3 * std::cos(a)}, {0, -std::sin(a / 2), 0, std::cos(a / 2)}});
        s.placed("receiver", meter(4), at(0, 0, -0.02));
        check(flux(s, 16), expected);
    }
}

// (A pipe of the same glass passes a little less on: total reflection turns the polarization of skew rays.)
TEST_CASE("a slab passes on of diffuse light what it does on average") {
    for (const auto& [ior, expected] : {std::pair{1.49, .8532139}, {1.586, .8318410}}) {
        SceneBuilder s;
        add_box(s, {200, 200, 0.001f}, glass(s, ior), false, at(0, 0, 0));
        s.rectangle(0.08, 0.08, s.black_emitter(1 / (pi * 0.08 * 0.08)), at(0, 0, -0.0006));
        s.placed("receiver", meter(200), {{0, 0, 0.0006}, {1, 0, 0, 0}});
        check(flux(s, 4e4, 60000), expected, 0.004);
    }
}

// Of even light glass reflects .0903062 from outside. With i = .5902465 from within, a guide whose white back
// of reflectance r is the lamp gives (1 - i) / (1 - r i) of its light away.
TEST_CASE("diffuse light at a face of glass, from outside and from a printed back") {
    SceneBuilder outside;
    outside.medium("glass", {{"ior", 1.49}});
    outside.rectangle(4000, 4000,
                      outside.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                      at(0, 0, 0));
    outside.rectangle(4000, 4000, outside.lambertian(0), at(0, 0, -0.01));
    outside.placed("receiver", meter(0.1), {{0, 0, 0.01}, {1, 0, 0, 0}});
    outside.environment(1);
    RenderPlan plan;
    plan.width = plan.height = 1, plan.passes = 16384, plan.seeds = 8;
    WindowMean seen = window_mean(render_estimates(outside.import(), plan));
    seen.mean /= pi, seen.standard_error /= pi;
    check(seen, .0903062, 0.01);

    for (const auto& [white, expected] : {std::pair{0.95, .9328144}, {0.9, .8740883}}) {
        SceneBuilder s;
        s.rectangle(100, 100, glass(s, 1.49), at(0, 0, 0.001));
        const double luminance = 1 / (pi * 0.01);
        const int lamp = s.material({{"surface", {{"class", "lambertian"}, {"reflectance", white}}},
                                     {"outside", "glass"},
                                     {"emission", {{"luminance", luminance}}}});
        const int print = s.material(
            {{"surface", {{"class", "lambertian"}, {"reflectance", white}}}, {"outside", "glass"}});
        s.rectangle(0.1, 0.1, lamp, at(0, 0, 0));
        s.shape({{"class", "disk"}, {"radius", 50}}, print, at(0, 0, -1e-6));
        s.placed("receiver", meter(100), {{0, 0, 0.002}, {1, 0, 0, 0}});
        check(flux(s, 1e4, 60000), expected, 0.004);
    }
}

// Random half balls over a plane, of cover d: what passes them on the way down, and down and up again; dents
// let all but d pass at any angle.
TEST_CASE("random hemispheres let light pass as their shadows on average do") {
    const double cover = 0.005, density = cover * 4 / pi;  // each in a cell that it may touch
    for (const bool dents : {false, true}) {
        json sheet = {{"size", {1, 1}}, {"pitch", {0.004, 0.004}}, {"radius", 0.002},
                      {"depth", 0.002}, {"density", density},      {"placement", "jittered"}};
        if (dents) sheet["operation"] = "remove";
        GeometryProbe probe;
        probe.add_shape("microstructure", sheet, {{-0.5f, -0.5f, -0.002f}, {0.5f, 0.5f, 0.002f}},
                        glm::dmat4(1));
        probe.build();
        for (const double degrees : {60, 80}) {
            CAPTURE(degrees);
            const double angle = degrees * pi / 180;
            Random random(3);
            std::vector<ProbeRay> rays, back;
            for (size_t i = 0; i < 100000; ++i) {
                const double turn = random(0, float(2 * pi));
                const glm::dvec3 d(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                                   -std::cos(angle));
                const glm::dvec3 target(random(-0.46f, 0.46f), random(-0.46f, 0.46f), 0);
                rays.push_back({target - 0.02 * d, 1e30f, d});
                back.push_back({target + 1e-7 * glm::dvec3(0, 0, 1), 1e30f, glm::vec3(d.x, d.y, -d.z)});
            }
            const auto down = probe.trace(rays, false), up = probe.trace(back, false);
            double passes = 0, passes_both = 0;
            for (size_t i = 0; i < rays.size(); ++i) {
                const bool on_plane = down[i].geometric_normal.z > 0.999999f;
                passes += on_plane, passes_both += on_plane && up[i].hit.primitive == no_record;
            }
            const double n = double(rays.size());
            const double once = dents ? std::exp(-cover) : std::exp(-cover * (1 + 1 / std::cos(angle)) / 2);
            const double both = dents ? once : std::exp(-cover / std::cos(angle));
            MESSAGE("once ", passes / n, " of ", once, ", both ways ", passes_both / n, " of ", both);
            CHECK(std::abs(once - passes / n) < 0.12 * (1 - once));
            CHECK(std::abs(both - passes_both / n) < 0.12 * (1 - both));
        }
    }
}

// E = pi sin² of the pupil's half angle in the middle; beside it as the integral over the pupil has it.
TEST_CASE("a meter behind a pupil gets of an even sky what the pupil's solid angle says") {
    for (const auto& [x, expected] : {std::pair{0.0, .18479957}, {0.01, .17233033}, {0.02, .14135409}}) {
        SceneBuilder s;
        s.environment(1);
        // The film stands still, its middle at x from the axis: the pupil is moved.
        json film = meter(1e-6);
        film["pupil"] = {0.05, 0.0125};
        s.placed("receiver", film, at(0, 0, 0));
        s.document["nodes"].back()["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, -x / 0.05, 0, 1, 0, 0, 0, 0, 1};
        s.document["nodes"].back().erase("translation");
        s.document["nodes"].back().erase("rotation");
        RenderPlan plan;
        plan.width = plan.height = 1, plan.passes = 4096, plan.seeds = 8;
        check(window_mean(render_estimates(s.import(), plan)), expected, 1e-4);
    }
}

// f = 50 mm, f/2, in focus at 2 m: the film is 51.282 mm behind the lens.
TEST_CASE("a point out of focus becomes a disk of the size that a thin lens gives it") {
    for (const auto& [distance, diameter] : {std::pair{4.0, .3205128e-3}, {1.0, .6410256e-3}}) {
        CAPTURE(distance);
        SceneBuilder s;
        const double film = 1e-3, behind = 1 / (1 / 0.05 - 1 / 2.0);
        s.placed("receiver",
                 {{"class", "thin_lens"},
                  {"yfov", 2 * std::atan(0.5 * film / behind)},
                  {"focus", 2},
                  {"aperture", 0.0125}},
                 at(0, 0, 0));
        s.sphere(2e-4, s.black_emitter(1e6), at(0, 0, -distance));
        RenderPlan plan;
        plan.width = plan.height = 100, plan.passes = 64, plan.seeds = 4, plan.algorithm = Algorithm::forward;
        const Estimates e = render_estimates(s.import(), plan);
        double sum = 0, second = 0;
        for (uint32_t y = 0; y < 100; ++y)
            for (uint32_t x = 0; x < 100; ++x) {
                const double u = (x + 0.5) / 100 - 0.5, v = (y + 0.5) / 100 - 0.5;
                sum += e.at(x, y, 1), second += e.at(x, y, 1) * (u * u + v * v);
            }
        REQUIRE(sum > 0);
        // Of an even disk the mean r² is half its radius squared.
        CHECK(2 * film * std::sqrt(2 * second / sum) == doctest::Approx(diameter).epsilon(0.01));
    }
}
