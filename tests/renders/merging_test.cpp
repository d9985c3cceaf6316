// Merging is right in the limit and wrong before it by what its radius says: light that a mirror throws on a
// floor which is itself seen in that mirror, so that nothing else brings it.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/bench/statistics.h"
#include "host/render/forward_rays.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double half_turn = 0.70710678118654752;
constexpr uint32_t pixels = 24;
constexpr double view = 1;            // m, width of what is seen of the floor, around the origin
constexpr double reflectance = 1e-4;  // hardly any light comes back to the floor
constexpr double intensity = 2e4;     // cd
const glm::dvec3 lamp(1.5, 0, 0.8), image_of_lamp(2.2, 0, 1.5);

// The mirror lies in x + z = 3. Parallel rays of the camera along +x meet it and go straight down: a point of
// the film z - 3 to the right shows the floor at x = 3 - z.
SceneBuilder mirrored_floor(double alpha = 0) {
    SceneBuilder s;
    s.orthographic(view / 2, {{-3, 0, 3}, {0, -half_turn, 0, half_turn}});
    const double turn = std::numbers::pi / 8;  // half of that from +z to (1, 0, 1) about +y
    s.rectangle(8, 4, s.surface({{"class", "conductor"}, {"reflectance", 1}, {"alpha", alpha}}),
                {{0, 0, 3}, {0, std::sin(turn), 0, std::cos(turn)}});
    s.light({{"type", "point"}, {"intensity", intensity}}, {lamp});
    return s;
}

double illuminance(const glm::dvec3& lamp, double x, double y) {
    const glm::dvec3 d = lamp - glm::dvec3(x, y, 0);
    return intensity * d.z / std::pow(glm::dot(d, d), 1.5);
}

// The mean of the illuminance that the mirror brings over the disk of a merging radius, by rings.
double merged_illuminance(double x, double y, double radius) {
    double sum = 0;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 8; ++k) {
            const double r = radius * std::sqrt((i + 0.5) / 4),
                         phi = 2 * std::numbers::pi * (k + 0.5 * (i % 2)) / 8;
            sum += illuminance(image_of_lamp, x + r * std::cos(phi), y + r * std::sin(phi)) / 32;
        }
    return sum;
}

// What `passes` passes show on average; radius: of the first one, m; 0 = without bias.
std::vector<double> floor_radiance(double radius, uint32_t passes) {
    std::vector<double> result(3 * pixels * pixels);
    constexpr double pixel = view / pixels;
    for (uint32_t py = 0; py < pixels; ++py)
        for (uint32_t px = 0; px < pixels; ++px) {
            double sum = 0;
            for (int i = 0; i < 4; ++i) {
                const double x = view / 2 - (px + (i % 2 + 0.5) / 2) * pixel;
                const double y = view / 2 - (py + (i / 2 + 0.5) / 2) * pixel;
                double merged = 0;
                for (uint32_t k = 0; k < passes; ++k)
                    merged += merged_illuminance(x, y, radius * merge_radius_factor(k)) / passes;
                sum += (illuminance(lamp, x, y) + merged) / 4;
            }
            for (size_t c = 0; c < 3; ++c)
                result[3 * (size_t(py) * pixels + px) + c] = reflectance / std::numbers::pi * sum;
        }
    return result;
}

RenderPlan floor_plan(double radius, uint32_t passes, uint32_t seeds) {
    RenderPlan plan;
    plan.width = plan.height = pixels;
    plan.passes = passes, plan.seeds = seeds;
    plan.algorithm = Algorithm::bidirectional;
    plan.merge_radius = float(radius * pixels / view);
    return plan;
}

}  // namespace

TEST_CASE("light that only merging brings is that of the mirrored lamp, but for the bias of the radius") {
    SceneBuilder s = mirrored_floor();
    s.rectangle(8, 8, s.lambertian(reflectance), at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    struct {
        double radius;  // m
        uint32_t passes, seeds;
    } const runs[] = {{0.1, 512, 16}, {0.8, 4, 64}, {0.8, 256, 16}};
    double bias[3];
    for (int i = 0; i < 3; ++i) {
        const auto [radius, passes, seeds] = runs[i];
        CAPTURE(radius);
        CAPTURE(passes);
        const Estimates e = render_estimates(scene, floor_plan(radius, passes, seeds));
        const std::vector<double> exact = floor_radiance(0, 1), merged = floor_radiance(radius, passes);
        const Agreement a = agreement(e, merged, 1), tiles = agreement(e, merged, 8);
        const WindowMean mean = window_mean(e);
        const double wanted = window_mean(merged, pixels, {});
        bias[i] = mean.mean / window_mean(exact, pixels, {}) - 1;
        MESSAGE("radius ", radius, " m, ", passes, " passes: pixels ", describe(a), "; tiles ",
                describe(tiles), "; ", 100 * (mean.mean / wanted - 1), " % +- ",
                100 * mean.standard_error / wanted, " % off what the radius says, bias ", 100 * bias[i],
                " %");
        CHECK(a.holds);
        CHECK(tiles.holds);
        CHECK(std::fabs(mean.mean - wanted) < 0.0005 * wanted + 4 * mean.standard_error);
        CHECK(mean.standard_error < 0.0015 * wanted);
    }
    CHECK(std::fabs(bias[0]) < 0.004);
    CHECK(std::fabs(bias[1]) > 0.005);
    CHECK(std::fabs(bias[2]) < 0.5 * std::fabs(bias[1]));
}

// Here vertices at the mirror, of either path, connect to those on the floor, which merge, too.
TEST_CASE(
    "light that comes and is seen by way of a nearly smooth mirror: connections leave merging its share") {
    SceneBuilder s = mirrored_floor(0.02);
    s.rectangle(4, 4, s.lambertian(0.5), at(0, 0, 0));
    Comparison c;
    c.width = c.height = pixels;
    c.backward = 2048, c.forward = 0, c.bidirectional = 32;
    c.merge_radius = float(0.1 * pixels / view);
    c.largest_error = 0.01;
    check_against_backward(s, c);
}

// A thin wall at x = 0 keeps both lamps' light from the floor behind it. A disk of the merging radius reaches
// across it, so the floor next to it is too bright on the one side and too dark on the other: by the radius,
// not by its square.
TEST_CASE("what merging leaks past a thin wall shrinks as the radius does") {
    SceneBuilder s = mirrored_floor();
    // A double sheet under the floor, nearer than the radius and lit from below by way of a mirror:
    // nothing of it may show.
    const int white = s.lambertian(reflectance);
    s.rectangle(8, 8, white, at(0, 0, 0));
    s.rectangle(8, 8, white, at(0, 0, -0.01));
    add_box(s, {8, 8, 0.01f}, white, false, at(0, 0, -0.03));
    s.rectangle(8, 8, s.surface({{"class", "conductor"}, {"reflectance", 1}}), at(0, 0, -2));
    s.light({{"type", "point"}, {"intensity", intensity}}, at(0, 0, -1));
    s.rectangle(1, 8, s.surface({{"class", "absorber"}}), facing_x(0, 0, 0.5));
    Scene scene = compile_test_scene(s.import());
    struct {
        uint32_t passes, seeds;
    } const runs[] = {{4, 256}, {512, 16}};
    constexpr double radius = 0.15;
    const double at_wall = reflectance / std::numbers::pi * illuminance(image_of_lamp, 0, 0);
    const Window bright = {0, 0, pixels / 2, pixels}, dark = {pixels / 2, 0, pixels / 2, pixels};
    const std::vector<double> exact = floor_radiance(0, 1);
    double leak[2];
    for (int i = 0; i < 2; ++i) {
        const auto [passes, seeds] = runs[i];
        CAPTURE(passes);
        const Estimates e = render_estimates(scene, floor_plan(radius, passes, seeds));
        // The part of a disk of radius r that lies across a line at distance a, integrated over a: 2 r / (3
        // pi).
        double mean_radius = 0;
        for (uint32_t k = 0; k < passes; ++k) mean_radius += radius * merge_radius_factor(k) / passes;
        const double wanted = at_wall * 2 * mean_radius / (3 * std::numbers::pi) / (view / 2);
        const WindowMean behind = window_mean(e, dark), before = window_mean(e, bright);
        const double lost = window_mean(exact, pixels, bright) - before.mean;
        MESSAGE(passes, " passes: behind the wall ", behind.mean, " +- ", behind.standard_error,
                ", by the radius ", wanted, "; before it ", lost, " +- ", before.standard_error,
                " is missing");
        CHECK(std::fabs(behind.mean - wanted) < 0.04 * wanted + 4 * behind.standard_error);
        CHECK(behind.standard_error < 0.08 * wanted);
        CHECK(std::fabs(lost - wanted) < 0.1 * wanted + 4 * before.standard_error);
        leak[i] = behind.mean;
        // Beyond the radius it is dark.
        const Window far = {uint32_t(pixels * (0.5 + radius / view)) + 1, 0, pixels / 4, pixels};
        CHECK(window_mean(e, far).mean < 1e-3 * at_wall);
    }
    CHECK(leak[1] < 0.55 * leak[0]);
}

// Variance grows as 1 / r² from pass to pass and the bias shrinks as r², so that r² ~ pass^(-1/3) makes the
// mean square of both fall as passes^(-2/3) (Knaus & Zwicker 2011, section 4). The light that comes without
// the mirror is unbiased and falls faster.
TEST_CASE("what merging brings converges as passes^(-2/3) or faster" * doctest::test_suite("long")) {
    SceneBuilder s = mirrored_floor();
    s.rectangle(8, 8, s.lambertian(reflectance), at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    const std::vector<double> exact = floor_radiance(0, 1);
    for (const double radius : {0.1, 0.8}) {  // m; noise is the larger part, then the bias
        std::vector<double> x, y;
        for (const uint32_t passes : {4u, 16u, 64u, 256u, 1024u}) {
            const uint32_t seeds = passes < 100 ? 32 : 8;
            const Estimates e = render_estimates(scene, floor_plan(radius, passes, seeds));
            double mse = 0;
            for (const auto& image : e.images)
                for (size_t i = 0; i < exact.size(); ++i)
                    mse += std::pow(image[i] / exact[i] - 1, 2) / double(exact.size() * e.images.size());
            MESSAGE("radius ", radius, " m, ", passes, " passes: mean square error ", mse);
            x.push_back(std::log(passes)), y.push_back(std::log(mse));
        }
        const auto fit = fit_line(x, y);
        REQUIRE(fit);
        MESSAGE("radius ", radius, " m: slope ", fit->slope, " +- ", fit->slope_error);
        CHECK(fit->slope < -2.0 / 3 + 0.04);
    }
}
