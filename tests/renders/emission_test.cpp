// Emissive surfaces that textures and alpha make brighter in some parts than in others, seen and as lights.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;
using std::numbers::pi;

namespace {

constexpr Algorithm algorithms[] = {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional};
constexpr ColorMode color_modes[] = {ColorMode::rgb, ColorMode::spectral};

json emitter(double radiance, const std::string& mode, double alpha) {
    return {{"alphaMode", mode},
            {"doubleSided", true},
            {"emissiveFactor", {1, 1, 1}},
            {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, alpha}}, {"metallicFactor", 0}}},
            {"extensions",
             {{"KHR_materials_emissive_strength", {{"emissiveStrength", radiance}}},
              {"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

SceneOptions in_colors(ColorMode color) {
    SceneOptions options = test_options();
    options.color = color;
    return options;
}

// Two triangles in the xy plane; uv as in an image.
void add_quad(SceneBuilder& s, double size, int material, const Place& place) {
    const float h = float(size / 2);
    s.mesh({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, {0, 1, 2, 0, 2, 3}, material, place, {},
           {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
}

// A small part of a floor of reflectance 0.5, 1 m below the middle of a lamp of 1 m².
struct Lamp {
    SceneDescription scene;
    int material;
};
Lamp lamp(const json& more) {
    SceneBuilder s;
    const int floor = s.lambertian(0.5), material = s.material(json::object(), more);
    add_quad(s, 1, material, facing_down(0, 0, 1));
    add_quad(s, 6, floor, at(0, 0, 0));
    s.orthographic(0.02, at(0, 0, 0.5));
    return {s.import(), material};
}

}  // namespace

TEST_CASE("emission: alpha covers it, as seen and by power, in every algorithm, in colours and wavelengths") {
    SceneBuilder s;
    const struct {
        const char* mode;
        double alpha, seen;
    } sheets[] = {{"OPAQUE", 0.25, 4}, {"BLEND", 0.25, 1}, {"MASK", 0.75, 4}, {"MASK", 0.25, 0}};
    for (int i = 0; i < 4; ++i)
        add_quad(s, 0.8, s.material(json::object(), emitter(4, sheets[i].mode, sheets[i].alpha)),
                 at(i - 1.5, 0, 0));
    s.orthographic(0.5, at(0, 0, 2));
    for (ColorMode color : color_modes) {
        Scene scene = compile_test_scene(s.import(), in_colors(color));
        CHECK(scene.power == doctest::Approx(2 * pi * 0.64 * 9).epsilon(1e-5));  // of the four, on both sides
        for (Algorithm algorithm : algorithms) {
            const Estimates e = render_estimates(
                scene, {.width = 16, .height = 4, .passes = 16, .seeds = 2, .algorithm = algorithm});
            for (int i = 0; i < 4; ++i) {
                CAPTURE(sheets[i].mode);
                CAPTURE(sheets[i].alpha);
                CAPTURE(algorithm_name(algorithm));
                // Wavelengths and the passes' share of them are not exact for white.
                CHECK(std::abs(e.at(4 * i + 1, 1, 1) - sheets[i].seen) <= 0.01 * sheets[i].seen);
            }
        }
    }
}

TEST_CASE("emission: a lamp that is there in part lights as the part that is there") {
    const Lamp whole = lamp(emitter(1, "OPAQUE", 1));
    // Every other texel of a fine chequer is there.
    Lamp part = lamp(emitter(2, "BLEND", 1));
    part.scene.images.push_back({.name = "chequer", .width = 32, .height = 32});
    for (int i = 0; i < 1024; ++i)
        part.scene.images[0].rgba32f.insert(part.scene.images[0].rgba32f.end(),
                                            {1, 1, 1, float((i + i / 32) % 2)});
    part.scene.textures.push_back({.nearest = true});
    part.scene.materials[size_t(part.material)].surface.parameters["base_color_texture"] = {{"index", 0}};
    Scene expected = compile_test_scene(whole.scene), covered = compile_test_scene(part.scene);
    CHECK(covered.power == doctest::Approx(expected.power).epsilon(1e-5));
    const RenderPlan plan{.width = 8, .height = 8, .passes = 64, .seeds = 4};
    const WindowMean a = window_mean(render_estimates(expected, plan));
    for (Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
        RenderPlan other = plan;
        other.algorithm = algorithm;
        const WindowMean b = window_mean(render_estimates(covered, other));
        CAPTURE(algorithm_name(algorithm));
        CHECK(std::abs(a.mean - b.mean) <
              0.003 * a.mean + 4 * std::hypot(a.standard_error, b.standard_error));
    }
}

TEST_CASE("emission: one bright texel of 256 x 256 lights a floor within 1 % after 256 passes") {
    for (bool nearest : {true, false}) {
        Lamp one = lamp(emitter(1e6, "OPAQUE", 1));
        one.scene.images.push_back({.name = "texel", .width = 256, .height = 256});
        one.scene.images[0].rgba8.assign(4 * 65536, 0);
        for (int c = 0; c < 3; ++c) one.scene.images[0].rgba8[4 * (128 * 256 + 128) + c] = 255;
        one.scene.textures.push_back({.wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp, .nearest = nearest});
        one.scene.materials[size_t(one.material)].emission->texture = {{"index", 0}};
        // A texel 1 m above: L A / d² of illuminance, of which 0.5 / pi is seen.
        const double expected = 1e6 / 65536 * 0.5 / pi;
        for (ColorMode color : color_modes) {
            Scene scene = compile_test_scene(one.scene, in_colors(color));
            CHECK(scene.power == doctest::Approx(2 * pi * 1e6 / 65536).epsilon(0.01));
            for (Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
                const Estimates e = render_estimates(
                    scene, {.width = 32, .height = 32, .passes = 256, .seeds = 1, .algorithm = algorithm});
                CAPTURE(nearest);
                CAPTURE(algorithm_name(algorithm));
                int beyond = 0;
                double worst = 0;
                for (double value : e.mean) {
                    const double off = std::abs(value / expected - 1);
                    beyond += off > 0.01, worst = std::max(worst, off);
                }
                CHECK(beyond <= 1);  // of 1024, at 3.7 standard deviations
                CAPTURE(color == ColorMode::rgb);
                CHECK(worst < 0.015);
            }
        }
        if (!nearest) continue;
        // Few forward rays meet what is seen: the mean over the image, of some 8000.
        Scene scene = compile_test_scene(one.scene);
        const Estimates e = render_estimates(
            scene, {.width = 64, .height = 64, .passes = 256, .seeds = 8, .algorithm = Algorithm::forward});
        const WindowMean m = window_mean(e);
        MESSAGE("forward: ", m.mean / expected, " +- ", m.standard_error / expected);
        CHECK(m.standard_error < 0.05 * expected);
        CHECK(std::abs(m.mean - expected) < 4 * m.standard_error);
    }
}
