// Polarized light in S0 to S3: forward and bidirectional rays against backward ones.
#include <doctest/doctest.h>

#include <glm/gtc/quaternion.hpp>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/sheets.h"
#include "tests/renders/stokes_means.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

constexpr double pi = std::numbers::pi;

namespace {

const json gold = {{"class", "conductor"}, {"eta", 0.2}, {"k", 3.4}, {"alpha", 0.5}};

// As add_room(), its walls of a metal.
void add_metal_room(SceneBuilder& s, const json& metal = gold) {
    add_box(s, {4, 4, 4}, s.surface(metal), true, at(0, 0, 0));
    s.perspective(1.2, at(0, 0, 1.95));
}

// Light turns circular before it reaches the metal.
SceneBuilder circular_light(const json& metal = gold) {
    SceneBuilder s;
    add_metal_room(s, metal);
    add_lamp(s, 1.5);
    s.rectangle(2, 2, s.surface(polarizer(0)), hanging(0, 1.9, 0));
    s.rectangle(2, 2, s.surface(wave_plate(pi / 4, pi / 2)), hanging(0, 1.88, 0));
    return s;
}

}  // namespace

// Light of a point source reaches the floor through sheets, by shadow rays, and from mirrors, glass and gold
// by hits, merging and connections; the camera looks through a sheet of its own.
TEST_CASE("polarized light: all algorithms agree") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.rectangle(2, 2, s.surface(polarizer(0.4)), hanging(0, 1.9, 0));
    s.rectangle(2, 2, s.surface(wave_plate(1.1, 1.2)), hanging(0, 1.88, 0));
    s.rectangle(0.3, 0.3, s.surface(wave_plate(0.9, 1.1)), at(0, 0, 1.8));
    s.sphere(
        0.5,
        s.surface({{"class", "conductor"}, {"eta", {0.2, 0.4, 1.4}}, {"k", {3.9, 2.4, 1.6}}, {"alpha", 0.2}}),
        at(-0.9, -1.4, -0.6));
    s.medium("glass", {{"class", "homogeneous"}, {"ior", 1.5}});
    for (double alpha : {0.0, 0.3})
        s.sphere(0.4,
                 s.material({{"surface", {{"class", "dielectric"}, {"alpha", alpha}}}, {"inside", "glass"}}),
                 at(alpha > 0 ? 0.9 : 0.1, -1.4, -0.2));
    s.rectangle(1.2, 1.2, s.surface({{"class", "thin_dielectric"}}),
                facing({1.2, 0.2, -1}, {-1, 0.4, 1}, {1, 0, 0}));
    s.rectangle(1.2, 1.2,
                s.surface({{"class", "reflective_polarizer"}, {"axis", 0.3}, {"pass", 0.9}, {"block", 0.8}}),
                facing({-1.1, 0.5, -1}, {1, 0.1, 0.8}, {1, 0, 0}));
    Comparison c;
    c.backward = 64, c.forward = 64, c.bidirectional = 32;
    c.tolerance = 0.003, c.largest_error = 0.012;
    c.stokes = true;
    check_against_backward(s, c);
}

// A wrong sign of all rows' S3 shows nowhere but where they meet the vectors of forward paths.
TEST_CASE("circular light among metals: all algorithms agree") {
    Comparison c;
    c.backward = 64, c.forward = 48, c.bidirectional = 32;
    c.largest_error = 0.01;
    c.stokes = true;
    check_against_backward(circular_light(), c);
}

// The same metal, tabulated: within what is linear between the nodes it shows the same.
TEST_CASE("circular light among measured metals: all algorithms agree, and with the metal itself") {
    const TemporaryFolder folder;
    const PolarizedMetal metal{0.5, [](double) { return std::complex(0.2, -3.4); }};
    const auto matrix = [&](double nm, const glm::dvec3& from, const glm::dvec3& to) {
        return metal_matrix(metal, nm, from, to);
    };
    write_text(folder / "gold.pbsdf",
               tensor_file_bytes(mueller_fields(even_nodes(49, 31, 31), {550}, matrix)));
    SceneOptions options = test_options();
    options.color = ColorMode::rgb;
    const SceneBuilder builder = circular_light({{"class", "mueller"}, {"file", "gold.pbsdf"}});
    Scene scene = compile_test_scene(builder.import(folder / "scene.gltf"), options);
    Comparison c;
    c.width = c.height = 16, c.seeds = 8, c.backward = 64, c.forward = 64, c.bidirectional = 32;
    c.largest_error = 0.015;
    c.stokes = true;
    check_against_backward(scene, c);
    RenderPlan plan;
    plan.width = c.width, plan.height = c.height, plan.passes = 64, plan.stokes = true;
    const StokesMeans tabulated = stokes_means(render_estimates(scene, plan)),
                      exact = stokes_means(render_estimates(circular_light().import(), plan));
    for (int i = 0; i < 4; ++i) {
        CAPTURE(i);
        CAPTURE(tabulated[i].mean);
        CAPTURE(exact[i].mean);
        const double error = std::hypot(tabulated[i].standard_error, exact[i].standard_error);
        CHECK(std::fabs(tabulated[i].mean - exact[i].mean) < 0.02 * exact[0].mean + 4 * error);
        CHECK(error < 0.015 * exact[0].mean);
    }
    CHECK(std::fabs(exact[3].mean) > 0.05 * exact[0].mean);
}

TEST_CASE("polarized light in fog: all algorithms agree") {
    SceneBuilder s;
    add_foggy_room(s, {{"class", "rayleigh"}}, {0.7, 0.5, 0.3});
    Comparison c;
    c.backward = 64, c.forward = 64, c.bidirectional = 32;
    c.largest_error = 0.01;
    c.stokes = true;
    check_against_backward(s, c);
}

TEST_CASE("polarized lights among metals: all algorithms agree") {
    SceneBuilder s;
    add_metal_room(s);
    s.rectangle(1.5, 1.5,
                s.material({{"surface", {{"class", "absorber"}}},
                            {"emission", {{"radiance", 2}, {"stokes", {1, 0.2, 0.4, 0.8}}}}}),
                hanging(0, 1.95, 0));
    s.placed("light", {{"class", "spot"}, {"intensity", 5}, {"stokes", {1, -0.8, 0, -0.6}}}, at(0.5, 0.5, 1));
    Comparison c;
    c.backward = 64, c.forward = 48, c.bidirectional = 32;
    c.largest_error = 0.015;
    c.stokes = true;
    check_against_backward(s, c);
}
