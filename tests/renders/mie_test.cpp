// Spheres that scatter each wavelength in another way, in whole images: colour and polarization of single
// scattering against the computed phase function, and forward and bidirectional rays against backward ones.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/error.h"
#include "host/mie/mie_table.h"
#include "host/spectra/color.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/sheets.h"
#include "tests/support/source_path.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi, sun = 3, scattered = 1e-4, absorbed = 1;

json droplets(double radius, double variance) {
    return {{"class", "mie"}, {"radius", radius}, {"variance", variance}, {"ior", 1.4}};
}

MieParameters parameters(double radius, double variance) {
    return {radius, variance, constant_spectrum(1.4), constant_spectrum(0), constant_spectrum(1)};
}

// Light falls in at 40 degrees, from the left (-x), on a slab of thickness 1 that hardly scatters; seen from
// above.
SceneDescription slab() {
    SceneBuilder s;
    s.medium("haze", {{"scattering", scattered}, {"absorption", absorbed}, {"phase", droplets(4e-7, 0.05)}});
    add_box(s, {6, 5, 1}, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "haze"}}), false,
            at(0, 0, -0.5));
    const double turned = -40 * pi / 180;
    s.light({{"type", "directional"}, {"intensity", sun}},
            {{0, 0, 0}, {0, std::sin(turned / 2), 0, std::cos(turned / 2)}});
    s.orthographic(0.5, at(0, 0, 2));
    return s.import();
}

Scene compiled(ColorMode color) {
    SceneOptions options = test_options();
    options.color = color, options.polarization = PolarizationMode::on;
    return compile_test_scene(slab(), options);
}

MieElements slab_radiance(double nm) {
    const double cosine = std::cos(40 * pi / 180), both = (scattered + absorbed) * (1 + 1 / cosine);
    return direct_mie_elements(parameters(4e-7, 0.05), nm, -cosine) *
           (sun * scattered * (1 - std::exp(-both)) / both);
}

void check_channels(const Estimates& e, const Window& window, const glm::dvec3& expected, double scale) {
    for (int c = 0; c < 3; ++c) {
        const WindowMean m = window_mean(e, window, c);
        CAPTURE(c);
        CAPTURE(m.mean / scale);
        CAPTURE(expected[c] / scale);
        CHECK(std::fabs(m.mean - expected[c]) < 5e-3 * scale + 4 * m.standard_error);
        CHECK(m.standard_error < 0.01 * scale);
    }
}

}  // namespace

TEST_CASE("droplets: single scattering has the colour and the polarization of the computed phase function") {
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 256, plan.stokes = true;
    Scene scene = compiled(ColorMode::automatic);
    const Estimates e = render_estimates(scene, plan);
    const glm::dvec3 s0 =
        rgb_of_radiance(white_light() * tabulate([](double nm) { return slab_radiance(nm).s11; }));
    const glm::dvec3 s1 =
        rgb_of_radiance(white_light() * tabulate([](double nm) { return slab_radiance(nm).b; }));
    const double y = luminance(s0);
    check_channels(e, {0, 0, 16, 16}, s0, y);
    // The plane of both directions lies along the rows, so S1 > 0 is along it: across is -S1.
    check_channels(e, {0, 16, 16, 16}, -s1, y);
    check_channels(e, {0, 32, 16, 16}, glm::dvec3(0), y);
    check_channels(e, {0, 48, 16, 16}, glm::dvec3(0), y);
    CHECK(std::fabs(luminance(s1)) > 0.02 * y);
    CHECK(std::fabs(s0.x - s0.z) > 0.02 * y);
}

TEST_CASE("droplets in colours: each channel has the phase function of its own wavelength") {
    Scene scene = compiled(ColorMode::rgb);
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 64;
    const Estimates e = render_estimates(scene, plan);
    const glm::dvec3 s0(slab_radiance(611).s11, slab_radiance(549).s11, slab_radiance(464).s11);
    check_channels(e, {}, s0, luminance(s0));
}

TEST_CASE("a scene's tables of droplets are those of its parameters, among them the medium's own index") {
    SceneBuilder s;
    const auto fog = [&](const char* name, double ior, const json& phase) {
        s.medium(name, {{"scattering", 1}, {"ior", ior}, {"phase", phase}});
        s.sphere(1, s.material({{"surface", {{"class", "boundary"}}}, {"inside", name}}), at(0, 0, 0));
    };
    fog("air", 1, droplets(1e-7, 0));
    fog("water", 1.33, droplets(4e-7, 0.05));
    fog("air again", 1, droplets(1e-7, 0));
    s.orthographic(1, at(0, 0, 2));
    Scene scene = compile_test_scene(s.import());
    CHECK(scene.features.spectral);
    MieParameters in_water = parameters(4e-7f, 0.05f);
    in_water.surrounding = constant_spectrum(1.33f);
    std::vector<glm::vec4> expected = make_mie_table(parameters(1e-7f, 0), 2).values;
    const auto second = make_mie_table(in_water, 2).values;
    expected.insert(expected.end(), second.begin(), second.end());
    const Buffer& values = *scene.shared_buffers.at("MieValues");
    REQUIRE(values.bytes() == expected.size() * sizeof(glm::vec4));
    CHECK(values.read_array<glm::vec4>(expected.size()) == expected);

    fog("rain", 1, droplets(1e-3, 0.1));
    CHECK_THROWS_WITH_AS(
        compile_test_scene(s.import()),
        doctest::Contains("media/3/phase/radius: 0.001 m; the largest of these spheres have the size"),
        Error);
}

TEST_CASE("droplets in a room: all algorithms agree, Stokes vectors included") {
    SceneBuilder s;
    add_foggy_room(s, droplets(6e-7, 0.05), 0.5);
    Comparison c;
    c.backward = 64, c.forward = 64, c.bidirectional = 32;
    c.largest_error = 0.015;
    c.stokes = true;
    check_against_backward(s, c);
}
