// Coarse meshes with smooth normals, and normal maps: what they scatter to the other side of the surface
// comes back, so that lossless things under a white sky cannot be seen.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;
using std::numbers::pi;

namespace {

constexpr int columns = 16, rows = 8;
constexpr double spacing = 2.2;

// A ball of few facets, its normals those of the sphere. Its axis is y.
void add_ball(SceneBuilder& s, int material, const Place& place) {
    std::vector<glm::vec3> points;
    std::vector<uint32_t> corners;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double polar = pi * row / rows, turn = 2 * pi * column / columns;
            points.push_back(
                {std::sin(polar) * std::cos(turn), std::cos(polar), -std::sin(polar) * std::sin(turn)});
        }
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = row * columns + column, b = row * columns + (column + 1) % columns;
            if (row > 0) corners.insert(corners.end(), {a, a + columns, b});
            if (row + 1 < rows) corners.insert(corners.end(), {b, a + columns, b + columns});
        }
    s.mesh(points, corners, material, place, points);
}

json white_metal(double roughness) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 1}, {"roughnessFactor", roughness}}}};
}

// Two balls that lose nothing: a mirror and glossy metal; what is rough and what is glass are other classes.
SceneDescription row_of_balls() {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}});
    const int balls[] = {
        s.material(json::object(), white_metal(0)),
        s.material({{"surface",
                     {{"class", "conductor"}, {"reflectance", 1}, {"alpha", 0.2}, {"multiscatter", true}}}}),
        s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
        s.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.2}, {"multiscatter", true}}},
                    {"inside", "glass"}}),
        s.lambertian(1)};
    for (int i = 0; i < 5; ++i) add_ball(s, balls[i], at(spacing * (i - 2), 0, 0));
    s.environment({1, 1, 1});
    s.orthographic(spacing / 2, at(0, 0, 5));
    return s.import();
}

}  // namespace

TEST_CASE(
    "shading normals: coarse balls that lose nothing are as bright as the white sky, in every algorithm") {
    Scene scene = compile_test_scene(row_of_balls());
    for (Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        const Estimates e = render_estimates(
            scene, {.width = 120, .height = 24, .passes = 64, .seeds = 4, .algorithm = algorithm});
        CAPTURE(algorithm_name(algorithm));
        for (uint32_t ball = 0; ball < 5; ++ball) {
            const Window window{24 * ball, 0, 24, 24};
            const WindowMean m = window_mean(e, window);
            CAPTURE(ball);
            MESSAGE(algorithm_name(algorithm), ", ball ", ball, ": ", m.mean, " +- ", m.standard_error);
            CHECK(std::abs(m.mean - 1) < 0.002 + 5 * m.standard_error);
            CHECK(m.standard_error < 0.06);
            // Smooth things are without noise, but for what they show of others.
            if ((ball != 0 && ball != 2) || algorithm == Algorithm::bidirectional) continue;
            for (uint32_t y = 0; y < 24; ++y)
                for (uint32_t x = 24 * ball; x < 24 * ball + 24; ++x)
                    CHECK(std::abs(e.at(x, y, 1) - 1) < 0.04);
        }
    }
}

TEST_CASE("shading normals: a mirror with a steep normal map is as bright as the white sky") {
    SceneBuilder s;
    const int material = s.material(json::object(), white_metal(0));
    s.mesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3}, material,
           Place{{0, 0, 0}, {std::sin(-0.6), 0, 0, std::cos(-0.6)}}, {}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
    s.environment({1, 1, 1});
    s.orthographic(0.3, at(0, 0, 5));
    SceneDescription description = s.import();
    ImageDescription image{.name = "bumps", .width = 4, .height = 4};
    for (int i = 0; i < 16; ++i) {
        const float x = 0.8f * float(i % 4 - 1.5) / 1.5f, y = 0.8f * float(i / 4 - 1.5) / 1.5f;
        image.rgba32f.insert(image.rgba32f.end(), {0.5f + 0.5f * x, 0.5f + 0.5f * y, 1, 1});
    }
    description.images.push_back(image);
    description.textures.push_back({});
    description.materials[size_t(material)].normal_texture = {{"index", 0}, {"scale", 1}};
    Scene scene = compile_test_scene(description);
    const Estimates e = render_estimates(scene, {.width = 16, .height = 16, .passes = 64, .seeds = 1});
    for (double value : e.mean) CHECK(value == doctest::Approx(1).epsilon(0.001));
}

TEST_CASE("shading normals: forward rays light a floor beside coarse balls as backward rays do") {
    SceneBuilder s;
    const int floor = s.lambertian(0.5);
    add_ball(s, s.material({{"surface", {{"class", "conductor"}, {"reflectance", 1}, {"alpha", 0.3}}}}),
             at(0, 0, 1.2));
    add_ball(s, s.lambertian(0.8), at(2.2, 0, 1.2));
    s.rectangle(8, 8, floor, at(1, 0, 0));
    s.rectangle(2, 2, s.black_emitter(4), facing_down(1, 3, 3));
    s.orthographic(2, at(1, 0, 6));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan{.width = 24, .height = 16, .passes = 128, .seeds = 8};
    const Estimates backward = render_estimates(scene, plan);
    for (Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        plan.algorithm = algorithm, plan.first_seed = 17;
        const Agreement tiles = agreement(render_estimates(scene, plan), backward, 4);
        MESSAGE(algorithm_name(algorithm), ": ", describe(tiles));
        CHECK(tiles.holds);
        CHECK(tiles.rms_z < 1.4);
    }
}
