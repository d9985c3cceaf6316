// Media whose density varies, in whole images: as bright as the integral of single scattering, the same as a
// homogeneous medium where density is even, invisible where nothing is lost, and the same whichever way rays
// go.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/sphere_row.h"
#include "tests/support/density_field.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
const json boundary = {{"class", "boundary"}};

int filled(SceneBuilder& s, const json& surface, const char* inside) {
    return s.material({{"surface", surface}, {"inside", inside}});
}

json lobe(double g) { return {{"class", "henyey_greenstein"}, {"g", g}}; }

// Hills and valleys without anything, of density up to 2.6, around the origin.
DensityField hills(double reach, uint32_t points) {
    return {glm::uvec3(points), glm::dvec3(-reach), glm::dvec3(reach), [=](glm::dvec3 p) {
                p *= 4 / reach;
                return std::max(0.0, std::sin(p.x + 1) + std::sin(1.3 * p.y) + std::cos(p.z) - 0.4);
            }};
}

}  // namespace

TEST_CASE(
    "single scattering in a slab whose density rises linearly with depth is as bright as its integral") {
    // Only the column of density above a depth counts, so the slab is as bright as an even one of the same
    // column.
    constexpr double scattered[3] = {1e-4, 2e-4, 0.5e-4}, absorbed[3] = {1, 0.5, 2}, sun = 3;
    TemporaryFolder folder;
    DensityField({2, 2, 9}, {-3, -3, -1}, {3, 3, 0}, [](glm::dvec3 p) {
        return -2 * p.z;
    }).write(folder / "ramp.nrrd");
    SceneBuilder s;
    s.medium("haze", {{"class", "grid"},
                      {"file", "ramp.nrrd"},
                      {"scattering", scattered},
                      {"absorption", absorbed},
                      {"phase", lobe(0.6)}});
    add_box(s, {5, 4, 1}, filled(s, boundary, "haze"), false, at(0, 0, -0.5));
    s.light({{"type", "directional"}, {"intensity", sun}},
            {{0, 0, 0}, {0, std::sin(-pi / 12), 0, std::cos(-pi / 12)}});
    s.orthographic(0.5, at(0, 0, 2));
    Scene scene = compile_test_scene(s.import(folder / "scene.gltf"));
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        RenderPlan plan;
        plan.width = plan.height = 16, plan.seeds = 8, plan.algorithm = algorithm;
        plan.passes = algorithm == Algorithm::backward ? 256 : 64;
        plan.forward_paths = algorithm == Algorithm::forward ? 64 : 4;
        const Estimates e = render_estimates(scene, plan);
        const double cosine = std::cos(pi / 6), both = 1 + 1 / cosine;
        const double phase = (1 - 0.36) / (4 * pi * std::pow(1.36 + 1.2 * cosine, 1.5));
        for (int c = 0; c < 3; ++c) {
            const double extinction = scattered[c] + absorbed[c];
            const double expected =
                sun * phase * scattered[c] / extinction * (1 - std::exp(-extinction * both)) / both;
            const WindowMean m = window_mean(e, {}, c);
            CAPTURE(algorithm_name(algorithm));
            CAPTURE(c);
            CAPTURE(m.mean);
            CAPTURE(expected);
            CHECK(std::fabs(m.mean - expected) < 5e-4 * expected + 4 * m.standard_error);
            CHECK(m.standard_error < 0.01 * expected);
        }
    }
}

TEST_CASE("where the density is even a grid gives the image of a homogeneous medium") {
    TemporaryFolder folder;
    DensityField({19, 6, 12}, glm::dvec3(-2.1), glm::dvec3(2.1), [](glm::dvec3) {
        return 0.5;
    }).write(folder / "even.nrrd");
    const auto room = [&](bool grid) {
        json fog = {
            {"scattering", {0.1, 0.25, 0.7}}, {"absorption", {0.02, 0.1, 0.03}}, {"phase", lobe(0.5)}};
        if (grid) fog["class"] = "grid", fog["file"] = "even.nrrd", fog["density"] = 2;
        SceneBuilder s;
        s.medium("fog", fog);
        add_box(s, {4, 4, 4},
                s.material({{"surface", {{"class", "lambertian"}, {"reflectance", {0.7, 0.5, 0.3}}}},
                            {"outside", "fog"}}),
                true, at(0, 0, 0));
        s.perspective(1.2, at(0, 0, 1.6));
        add_lamp(s, 1.2);
        return s.import(folder / "scene.gltf");
    };
    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.passes = 128;
    const Estimates expected = render_estimates(room(false), plan);
    plan.first_seed = 1001;
    check_agreement("grid", render_estimates(room(true), plan), expected);
}

TEST_CASE("the same in wavelengths that part at glass, where only one lane is left") {
    TemporaryFolder folder;
    DensityField({4, 4, 4}, glm::dvec3(-2), glm::dvec3(2), [](glm::dvec3) {
        return 0.5;
    }).write(folder / "even.nrrd");
    const auto table = [](double at_400, double at_700) {
        return json{{"wavelengths", {400, 700}}, {"values", {at_400, at_700}}};
    };
    const auto ball = [&](bool grid) {
        json dye = {{"ior", {{"name", "SF11 ior"}}},
                    {"scattering", table(2, 0.3)},
                    {"absorption", table(0.05, 0.5)},
                    {"phase", lobe(0.3)}};
        if (grid) dye["class"] = "grid", dye["file"] = "even.nrrd", dye["density"] = 2;
        SceneBuilder s;
        s.medium("dye", dye);
        s.sphere(1, filled(s, {{"class", "dielectric"}}, "dye"), at(0, 0, 0));
        s.environment({1, 1, 1});
        s.light({{"type", "directional"}, {"intensity", 3}}, {{0, 0, 0}, {0, 0.5, 0, std::sqrt(0.75)}});
        s.orthographic(1.1, at(0, 0, 4));
        Scene scene = compile_test_scene(s.import(folder / "scene.gltf"));
        CHECK(scene.features.spectral);
        CHECK(scene.features.dispersion);
        RenderPlan plan;
        plan.width = plan.height = 24, plan.seeds = 16, plan.passes = 256, plan.first_seed = grid ? 1001 : 1;
        return render_estimates(scene, plan);
    };
    check_agreement("grid", ball(true), ball(false), 0.002, 0.01);
}

TEST_CASE("lossless clouds are invisible under a constant environment") {
    struct Cloud {
        std::string name;
        json surface, scattering, phase;
    };
    const std::vector<Cloud> clouds = {{"grey", boundary, 3, lobe(0)},
                                       {"coloured", boundary, {0.3, 3, 12}, lobe(0.3)},
                                       {"forward", boundary, 10, lobe(0.95)},
                                       {"in glass", {{"class", "dielectric"}}, 2, lobe(0.5)}};
    TemporaryFolder folder;
    hills(1.2, 24).write(folder / "hills.nrrd");
    const double sky[3] = {0.5, 1, 2};
    SceneBuilder s;
    for (size_t i = 0; i < clouds.size(); ++i) {
        const double x = sphere_spacing * (double(i) + 0.5);
        s.medium(clouds[i].name, {{"class", "grid"},
                                  {"file", {{"name", "hills.nrrd"}, {"translation", {x, 0, 0}}}},
                                  {"ior", clouds[i].surface == boundary ? 1.0 : 1.4},
                                  {"scattering", clouds[i].scattering},
                                  {"phase", clouds[i].phase}});
        s.sphere(1, filled(s, clouds[i].surface, clouds[i].name.c_str()), at(x, 0, 0));
    }
    s.environment({sky[0], sky[1], sky[2]});
    s.orthographic(1.1, at(1.1 * double(clouds.size()), 0, 5));
    Scene scene = compile_test_scene(s.import(folder / "scene.gltf"));
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
        RenderPlan plan;
        plan.width = sphere_pixels * uint32_t(clouds.size()), plan.height = sphere_pixels;
        plan.algorithm = algorithm;
        plan.passes = algorithm == Algorithm::backward ? 128 : 32;
        const Estimates e = render_estimates(scene, plan);
        for (size_t i = 0; i < clouds.size(); ++i) {
            const WindowMean m = disk_albedo(e, i, 0.95, sky);
            CAPTURE(std::string(algorithm_name(algorithm)));
            CAPTURE(clouds[i].name);
            CAPTURE(m.mean);
            CAPTURE(m.standard_error);
            CHECK(std::fabs(m.mean - 1) < 0.001 + 4 * m.standard_error);
            CHECK(m.standard_error < 0.008);
        }
        CHECK(e.counters.depth_limit == 0);
        CHECK(e.counters.non_finite == 0);
        CHECK(e.counters.forward_non_finite == 0);
    }
}

namespace {

// A cloud of hills and holes in a room, coloured, and beside it a glass of uneven ink that does not scatter,
// or of milk, where vertices merge.
void add_clouds(SceneBuilder& s, const TemporaryFolder& folder, bool milk = false) {
    hills(0.9, 20).write(folder / "hills.nrrd");
    const auto grid = [&](const glm::dvec3& place, json scattering, json absorption) {
        return json{{"class", "grid"},
                    {"file", {{"name", "hills.nrrd"}, {"translation", {place.x, place.y, place.z}}}},
                    {"scattering", scattering},
                    {"absorption", absorption},
                    {"phase", lobe(0.4)}};
    };
    s.medium("cloud", grid({-0.7, -0.3, 0}, {3, 2, 1}, {0.1, 0.3, 0.6}));
    json ink = milk ? grid({1, -0.7, 0.2}, {2, 3, 4}, {0.4, 0.2, 0.1}) : grid({1, -0.7, 0.2}, 0, {0.4, 1, 2});
    ink["ior"] = 1.4;
    s.medium("ink", ink);
    s.sphere(0.85, filled(s, boundary, "cloud"), at(-0.7, -0.3, 0));
    s.sphere(0.7, filled(s, {{"class", "dielectric"}}, "ink"), at(1, -0.7, 0.2));
}

void check_clouds(bool milk, const Comparison& c) {
    TemporaryFolder folder;
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.2);
    add_clouds(s, folder, milk);
    check_against_backward(s, c, folder / "scene.gltf");
}

}  // namespace

TEST_CASE("algorithms agree: a coloured cloud, and uneven ink in glass") {
    Comparison c;
    c.backward = 48, c.forward = 24, c.bidirectional = 10, c.largest_error = 0.008;
    check_clouds(false, c);
}

TEST_SUITE("long") {
    TEST_CASE("algorithms agree: a coloured cloud, and uneven ink in glass, with less noise") {
        check_clouds(false, {});
    }
    TEST_CASE("algorithms agree: a coloured cloud, and uneven milk in glass") {
        Comparison c;
        c.backward = 768, c.forward = 128, c.bidirectional = 64, c.seeds = 12;
        check_clouds(true, c);
    }
}

TEST_CASE("clouds: by schedule the same film bit for bit") {
    TemporaryFolder folder;
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.2);
    add_clouds(s, folder);
    const SceneDescription description = s.import(folder / "scene.gltf");
    Scene scene = compile_test_scene(description);
    RenderPlan plan;
    plan.width = plan.height = 32, plan.passes = 4;
    const FilmState fused = render_film(scene, plan, Schedule::fused, {4});
    CHECK(fused.pixels == render_film(scene, plan, Schedule::wavefront, {1, 3}).pixels);
}

TEST_CASE("densities out of all proportion are opaque, and take no longer than others") {
    // Half of the points are empty: there light would collide with nothing 10^30 times. What is thicker than
    // can be resolved is all the same.
    TemporaryFolder folder;
    const auto image = [&](float density, double reach) {
        DensityField(glm::uvec3(9), glm::dvec3(-reach), glm::dvec3(reach), [=](glm::dvec3 p) {
            return p.x < 0 ? 0.0f : density;
        }).write(folder / "wall.nrrd");
        SceneBuilder s;
        s.medium("wall", {{"class", "grid"}, {"file", "wall.nrrd"}, {"absorption", 1}, {"scattering", 1}});
        add_box(s, {3, 3, 3}, filled(s, boundary, "wall"), false, at(0, 0, 0));
        s.orthographic(1.5, at(0, 0, 3));
        s.environment(1);
        RenderPlan plan;
        plan.width = plan.height = 16, plan.passes = 16, plan.seeds = 1;
        return render_estimates(s.import(folder / "scene.gltf"), plan);
    };
    const Estimates thick = image(1e12f, 1), thicker = image(1e30f, 1), large = image(1e30f, 1e6);
    CHECK(thick.images[0] == thicker.images[0]);
    CHECK(window_mean(thick, {0, 0, 5, 16}).mean == 1);  // nothing is there
    const double albedo = window_mean(thick, {9, 1, 6, 14}).mean;
    CHECK(albedo > 0.05);
    CHECK(albedo < 0.5);
    CHECK(window_mean(large).mean < 1);
    CHECK(large.counters.non_finite == 0);
}
