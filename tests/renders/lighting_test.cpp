// Lights of every kind over a diffuse floor, against closed forms.
//
// Each cell has its light and a floor of reflectance 0.5 at z = 0; the camera hangs under the lights.
// Emitting things that it is to see lie on the floor.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/image/exr.h"
#include "tests/renders/cell_row.h"
#include "tests/renders/form_factors.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using std::numbers::pi;

namespace {

std::vector<glm::dvec3> rectangle_above(double x, double y, double width, double height, double z) {
    return {{-width / 2 - x, -height / 2 - y, z},
            {width / 2 - x, -height / 2 - y, z},
            {width / 2 - x, height / 2 - y, z},
            {-width / 2 - x, height / 2 - y, z}};
}

// The part of [x0, x1] that lies within [-half, half] around c.
double overlap(double x, double pixel, double c, double half) {
    return std::max(0.0, std::min(x + pixel / 2, c + half) - std::max(x - pixel / 2, c - half)) / pixel;
}

const nlohmann::json along_x = {0, 0.70710678118654752, 0, 0.70710678118654752};  // z axis becomes x

std::vector<Cell> cells() {
    constexpr double pixel = cell_size / cell_pixels;
    return {
        {"sphere",
         [](SceneBuilder& s, double x) { add_floor(s, x), s.sphere(0.3, s.black_emitter(2), at(x, 0, 0.8)); },
         [](double x, double y) {
             return floor_radiance(2 * sphere_irradiance(0.3, {-x, -y, 0.8}, up));
         }},
        {"disk",
         [](SceneBuilder& s, double x) {
             add_floor(s, x),
                 s.shape({{"class", "disk"}, {"radius", 0.5}}, s.black_emitter(3), facing_down(x, 0, 0.7));
         },
         [](double x, double y) { return floor_radiance(3 * disk_irradiance(0.5, 0.7, std::hypot(x, y))); }},
        {"rectangle",
         [](SceneBuilder& s, double x) {
             add_floor(s, x), s.rectangle(1.2, 0.5, s.black_emitter(4), facing_down(x, 0, 0.6));
         },
         [](double x, double y) {
             return floor_radiance(4 * polygon_irradiance(rectangle_above(x, y, 1.2, 0.5, 0.6), up));
         }},
        {"cylinder, lying",
         [](SceneBuilder& s, double x) {
             add_floor(s, x);
             s.shape({{"class", "cylinder"}, {"radius", 0.2}, {"height", 1.2}}, s.black_emitter(2),
                     Place{{x, 0, 0.7}, along_x});
         },
         [](double x, double y) {
             const auto surface = [](double u, double v) {
                 const double phi = 2 * pi * v;
                 const glm::dvec3 n(0, std::cos(phi), std::sin(phi));
                 return SurfaceElement{glm::dvec3(1.2 * (u - 0.5), 0, 0.7) + 0.2 * n, n, 2 * pi * 0.2 * 1.2};
             };
             return floor_radiance(2 * quadrature_irradiance(surface, {x, y, 0}, up, 128));
         }},
        {"mesh of two triangles",
         [](SceneBuilder& s, double x) {
             add_floor(s, x);
             s.mesh({{-0.6f, -0.25f, 0}, {0.6f, -0.25f, 0}, {0.6f, 0.25f, 0}, {-0.6f, 0.25f, 0}},
                    {0, 1, 2, 0, 2, 3}, s.black_emitter(4), facing_down(x, 0, 0.6));
         },
         [](double x, double y) {
             return floor_radiance(4 * polygon_irradiance(rectangle_above(x, y, 1.2, 0.5, 0.6), up));
         }},
        {"emission given as flux: 10 lm from 0.6 m²",
         [](SceneBuilder& s, double x) {
             add_floor(s, x);
             s.rectangle(1.2, 0.5,
                         s.material({{"surface", {{"class", "absorber"}}}, {"emission", {{"flux", 10}}}}),
                         facing_down(x, 0, 0.6));
         },
         [](double x, double y) {
             return floor_radiance(10 / (pi * 0.6) *
                                   polygon_irradiance(rectangle_above(x, y, 1.2, 0.5, 0.6), up));
         }},
        {"point",
         [](SceneBuilder& s, double x) {
             add_floor(s, x), s.light({{"type", "point"}, {"intensity", 5}}, at(x + 0.3, 0, 0.5));
         },
         [](double x, double y) { return point_light(x - 0.3, y, 0.5, 5); }},
        {"spot",
         [](SceneBuilder& s, double x) {
             add_floor(s, x);
             s.light({{"type", "spot"},
                      {"intensity", 6},
                      {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.9}}}},
                     at(x, 0, 0.9));
         },
         [](double x, double y) {
             const double c = 0.9 / std::sqrt(x * x + y * y + 0.81);
             const double t = std::clamp((c - std::cos(0.9)) / (std::cos(0.3) - std::cos(0.9)), 0.0, 1.0);
             return point_light(x, y, 0.9, 6 * t * t);
         }},
        // What the camera sees itself: radiance 1 for an emissive factor of 1, by the part of each pixel that
        // it covers.
        {"emissive factor",
         [](SceneBuilder& s, double x) {
             s.rectangle(1.1, 0.7,
                         s.material({{"surface", {{"class", "lambertian"}, {"reflectance", 0}}}},
                                    {{"emissiveFactor", {1, 1, 1}}}),
                         at(x + 0.03, 0.05, 0));
         },
         [](double x, double y) { return overlap(x, pixel, 0.03, 0.55) * overlap(y, pixel, 0.05, 0.35); },
         true},
        {"luminance with a spectrum",
         [](SceneBuilder& s, double x) {
             s.rectangle(1, 1,
                         s.material({{"surface", {{"class", "absorber"}}},
                                     {"emission", {{"luminance", 3}, {"spectrum", 0.25}}}}),
                         at(x, 0, 0));
         },
         [](double x, double y) { return 3 * overlap(x, pixel, 0, 0.5) * overlap(y, pixel, 0, 0.5); }, true},
        {"the back of an emitter is dark",
         [](SceneBuilder& s, double x) { s.rectangle(1, 1, s.black_emitter(100), facing_down(x, 0, 0)); },
         [](double, double) { return 0.0; }},
    };
}

}  // namespace

TEST_CASE("lights of every kind give a diffuse floor its analytic radiance, and emitters show theirs") {
    RenderPlan plan;
    plan.passes = 128, plan.seeds = 8;
    check_row(cells(), plan);
}

TEST_CASE("ten thousand emissive triangles of unequal size and brightness add up to their closed form") {
    // In one plane, so that none hides another: a lattice of squares, each holding one triangle of its own
    // size.
    constexpr int side = 100;
    constexpr double width = 4, h = 0.5, view = 1;  // m
    SceneBuilder scene;
    struct Emitter {
        std::vector<glm::dvec3> corners;
        double radiance;
    };
    std::vector<Emitter> emitters;
    const double levels[4] = {0.3, 3, 30, 300};
    std::vector<glm::vec3> positions[4];
    std::vector<uint32_t> indices[4];
    uint32_t state = 12345;
    const auto random = [&] {
        return double((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24);
    };
    for (int i = 0; i < side * side; ++i) {
        const int level = std::min(3, int(-std::log2(random() + 1e-9) / 1.5));
        const double scale = width / side * (0.1 + 0.8 * random());
        const glm::dvec3 corner((i % side) * width / side - width / 2, (i / side) * width / side - width / 2,
                                h);
        // Facing down: clockwise seen from above.
        Emitter emitter{{corner, corner + glm::dvec3(0, scale, 0), corner + glm::dvec3(scale, 0, 0)},
                        levels[level]};
        for (glm::dvec3& p : emitter.corners) {
            indices[level].push_back(uint32_t(positions[level].size()));
            positions[level].push_back(glm::vec3(p));
            p = glm::dvec3(positions[level].back());
        }
        emitters.push_back(std::move(emitter));
    }
    for (int level = 0; level < 4; ++level)
        scene.mesh(positions[level], indices[level], scene.black_emitter(levels[level]), at(0, 0, 0));
    scene.rectangle(2, 2, scene.lambertian(reflectance), at(0, 0, 0));
    scene.orthographic(view / 2, at(0, 0, 0.1));
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 512, plan.seeds = 8;
    const Estimates e = render_estimates(scene.import(), plan);
    std::vector<double> expected(e.mean.size()), sd(e.mean.size());
    for (uint32_t y = 0; y < 16; ++y)
        for (uint32_t x = 0; x < 16; ++x) {
            double sum = 0;
            for (int k = 0; k < 4; ++k) {
                const glm::dvec3 p(view * ((x + 0.25 + 0.5 * (k % 2)) / 16 - 0.5),
                                   view * (0.5 - (y + 0.25 + 0.5 * (k / 2)) / 16), 0);
                for (const Emitter& emitter : emitters)
                    sum += emitter.radiance / 4 *
                           polygon_irradiance(
                               {emitter.corners[0] - p, emitter.corners[1] - p, emitter.corners[2] - p}, up);
            }
            for (int c = 0; c < 3; ++c) {
                expected[3 * (y * 16 + x) + size_t(c)] = floor_radiance(sum);
                sd[3 * (y * 16 + x) + size_t(c)] = 0.001 * floor_radiance(sum);
            }
        }
    const WindowMean m = window_mean(e);
    const double wanted = window_mean(expected, 16, {});
    CAPTURE(m.mean);
    CAPTURE(wanted);
    CAPTURE(m.standard_error);
    CHECK(std::fabs(m.mean - wanted) < 0.0005 * wanted + 4 * m.standard_error);
    CHECK(m.standard_error < 0.002 * wanted);
    for (const uint32_t tile : {1u, 4u}) {
        const Agreement a = agreement(e, expected, tile, sd);
        CHECK_MESSAGE(a.holds, describe(a));
    }
}

TEST_CASE("one bright texel of an environment image lights a floor within 1 % after 256 passes") {
    constexpr int columns = 256, rows = 128, column = 20, row = 50;
    constexpr double radiance = 1e6;
    const TemporaryFolder folder;
    Image sky{.width = columns, .height = rows};
    std::vector<float> pixels(3 * columns * rows, 0.0f);
    for (int c = 0; c < 3; ++c) pixels[3 * (row * columns + column) + size_t(c)] = float(radiance);
    add_channels(sky, {"R", "G", "B"}, pixels, 3);
    write_exr(folder / "sky.exr", sky);

    SceneBuilder s;
    s.rectangle(1, 1, s.lambertian(0.5), at(0, 0, 0));
    s.orthographic(0.5, at(0, 0, 0.5));
    s.optics()["environment"] = {{"class", "image"}, {"file", "sky.exr"}};
    // A direction has z = -sin(polar) cos(turn), the solid angle another sine; the middle of the image is
    // turn 0.
    const auto of_polar = [](double angle) { return angle / 2 - std::sin(2 * angle) / 4; };
    const auto of_turn = [](double place) { return -std::sin(2 * pi * (place / columns - 0.5)); };
    const double expected =
        floor_radiance(radiance * (of_polar(pi * (row + 1) / rows) - of_polar(pi * row / rows)) *
                       (of_turn(column + 1) - of_turn(column)));
    for (ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
        SceneOptions options = test_options();
        options.color = color;
        Scene scene = compile_test_scene(s.import(folder / "scene.gltf"), options);
        for (Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
            CAPTURE(algorithm_name(algorithm));
            const bool forward = algorithm == Algorithm::forward;  // as even as its paths are many
            const Estimates e = render_estimates(scene, {.width = 8,
                                                         .height = 8,
                                                         .passes = forward ? 4096u : 256u,
                                                         .seeds = 1,
                                                         .algorithm = algorithm});
            CHECK(window_mean(e.mean, 8, {}) == doctest::Approx(expected).epsilon(0.005));
            double worst = 0;
            for (double value : e.mean) worst = std::max(worst, std::abs(value / expected - 1));
            CHECK(worst < (algorithm == Algorithm::backward ? 0.01 : 0.1));
        }
    }
}
