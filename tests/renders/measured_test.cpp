// Measured surfaces in whole renders: their colours in wavelengths, and forward rays against backward ones.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/spectra/color.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/bsdf_files.h"

using namespace etendue;
using nlohmann::json;

namespace {

using std::numbers::pi;

struct Files {
    TemporaryFolder folder;
    // A surface of a file that is written for it.
    json table(const std::string& name, const json& content) const {
        write_text(folder / name, content.dump());
        return {{"class", "measured"}, {"file", name}};
    }
    json rgl(const std::string& name, const TensorFields& fields) const {
        write_text(folder / name, tensor_file_bytes(fields));
        return {{"class", "measured"}, {"file", name}};
    }
    std::filesystem::path scene() const { return folder / "scene.gltf"; }
};

json angles(size_t swept) {
    return {
        {"theta_i", even_angles(0, 80, 5)}, {"theta_r", even_angles(0, 90, swept)}, {"phi", {0, 60, 180}}};
}

json matte_table(const json& value) {
    json table = angles(3);
    table["reflection"] = table_side(table, [&](double, double, double) { return value; });
    return table;
}

// Reflects more one way than the other, and so does what it transmits.
json lopsided_table() {
    json table = {
        {"theta_i", {0, 30, 55, 80}}, {"theta_r", {5, 20, 50, 70, 88}}, {"phi", even_angles(0, 360, 13)}};
    const auto value = [](const glm::dvec3& color) {
        return [=](double i, double r, double p) {
            const double v = (1 + i / 90) * (1.3 + std::cos((p - 40) * pi / 180)) * (r > 60 ? 0.2 : 1);
            return json({color.x * v, color.y * v, color.z * v});
        };
    };
    table["reflection"] = table_side(table, value({0.06, 0.05, 0.03}));
    table["transmission"] = table_side(table, value({0.02, 0.03, 0.05}));
    return table;
}

GgxMetal metal(double alpha_x, double alpha_y) {
    return {alpha_x, alpha_y, [](double cosine, size_t channel) {
                const double eta[3] = {0.143, 0.375, 1.442}, k[3] = {3.983, 2.386, 1.603};
                return conductor_reflectance(cosine, eta[channel], k[channel]);
            }};
}

RglResolution small_resolution(bool anisotropic) {
    RglResolution resolution;
    resolution.points = 32, resolution.value_points = 16;
    if (anisotropic) resolution.phi_i = even_angles(-pi, 0, 9);
    return resolution;
}

}  // namespace

TEST_CASE("measured surfaces have the colours that their spectra have") {
    const std::vector<double> nm = {380, 480, 520, 600, 700}, reflected = {0.1, 0.7, 0.05, 0.9, 0.3};
    const Files files;
    json spectral = angles(2), values;
    spectral["wavelengths"] = nm;
    for (const double r : reflected) values.push_back(r / pi);
    spectral["reflection"] = table_side(spectral, [&](double, double, double) { return values; });
    // A metal of the same reflectance, against the class that the file is made after.
    const GgxMetal painted{0.3, 0.3, [&](double, size_t channel) { return reflected[channel]; }};
    const json paint = {{"wavelengths", nm}, {"values", reflected}};
    const glm::dvec3 color(0.3, 0.8, 0.25);
    SceneBuilder scene;
    const auto patch = [&](const json& surface, int i) {
        scene.rectangle(2, 2, scene.surface(surface), at(2 * i + 1, 0, 0));
    };
    patch(files.table("spectral.json", spectral), 0);
    patch({{"class", "lambertian"}, {"reflectance", paint}}, 1);
    patch(files.rgl("metal.bsdf", rgl_fields(painted, nm)), 2);
    patch({{"class", "conductor"}, {"reflectance", paint}, {"alpha", 0.3}}, 3);
    patch(files.table("color.json", matte_table({color.x / pi, color.y / pi, color.z / pi})), 4);
    scene.environment({{"illuminant", "D65"}});
    scene.orthographic(1, at(5, 0, 1));
    Scene compiled = compile_test_scene(scene.import(files.scene()));
    REQUIRE(compiled.features.spectral);
    RenderPlan plan;
    plan.width = 5, plan.height = 1, plan.passes = 1024, plan.seeds = 4;
    const Estimates e = render_estimates(compiled, plan);
    const double y = luminance(glm::dvec3(e.at(1, 0, 0), e.at(1, 0, 1), e.at(1, 0, 2)));
    for (int c = 0; c < 3; ++c) {
        CAPTURE(c);
        CHECK(std::fabs(e.at(0, 0, c) - e.at(1, 0, c)) < 0.005 * y);
        CHECK(std::fabs(e.at(2, 0, c) - e.at(3, 0, c)) < 0.01 * y);
        CHECK(std::fabs(e.at(4, 0, c) - color[c]) < 0.008 * luminance(color));
    }
}

TEST_CASE("a white table is invisible in an even surround, whatever the direction, by all algorithms") {
    const Files files;
    SceneBuilder scene;
    scene.sphere(1.5, scene.surface(files.table("white.json", matte_table(1 / pi))), at(0, 0, 0));
    scene.environment(1);
    scene.orthographic(2, at(0, 0, 5));
    Scene compiled = compile_test_scene(scene.import(files.scene()));
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 128, plan.seeds = 4;
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        plan.algorithm = algorithm;
        const WindowMean mean = window_mean(render_estimates(compiled, plan));
        CAPTURE(algorithm_name(algorithm));
        CHECK(std::fabs(mean.mean - 1) < 2e-4 + 4 * mean.standard_error);
        CHECK(mean.standard_error < 0.01);
    }
}

TEST_SUITE("long") {
    TEST_CASE("algorithms agree: measured surfaces that reflect and transmit more one way than the other") {
        const Files files;
        SceneBuilder s;
        add_room(s);
        add_lamp(s, 1.5);
        s.sphere(0.3, s.black_emitter({6, 4, 3}), at(1.2, 1.2, 0.6));
        const int lopsided = s.surface(files.table("lopsided.json", lopsided_table()));
        s.sphere(0.55, lopsided, at(-1.3, -1.4, -0.6));
        s.rectangle(1.6, 1.6, lopsided, hanging(0.2, 0.6, -0.4));
        s.medium("water", {{"ior", 1.33}});
        s.sphere(
            0.5,
            s.material({{"surface", files.table("lopsided.json", lopsided_table())}, {"inside", "water"}}),
            at(1.2, -1.4, -0.6));
        check_against_backward(s, {}, files.scene());
    }

    TEST_CASE("algorithms agree: measured metals, plain and brushed") {
        const Files files;
        SceneBuilder s;
        add_room(s);
        add_lamp(s, 1.5);
        s.sphere(0.6,
                 s.surface(files.rgl("gold.bsdf", rgl_fields(metal(0.4, 0.4), {}, small_resolution(false)))),
                 at(-1.2, -1.4, -0.6));
        s.sphere(
            0.6,
            s.surface(files.rgl("brushed.bsdf", rgl_fields(metal(0.25, 0.5), {}, small_resolution(true)))),
            at(0.5, -1.4, -0.6));
        check_against_backward(s, {}, files.scene());
    }
}
