// Bodies of uniaxial crystals: energy, double images, crossed polarizers, dichroism, and transport both ways.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "host/error.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/sheets.h"
#include "tests/renders/stokes_means.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double no = 1.6584, ne = 1.4864;  // calcite at 589 nm

json calcite(const json& axis) {
    return {{"class", "uniaxial"}, {"ior_ordinary", no}, {"ior_extraordinary", ne}, {"axis", axis}};
}

int crystal(SceneBuilder& s, const json& medium, int priority = 0) {
    s.medium("crystal", medium);
    json material = {{"surface", {{"class", "dielectric"}}}, {"inside", "crystal"}};
    if (priority > 0) material["priority"] = priority;
    return s.material(material);
}

// Of a plate with its echoes, at normal incidence on a face of that index.
double plate(double index) {
    const double r = std::pow((index - 1) / (index + 1), 2);
    return (1 - r) / (1 + r);
}

StokesMeans seen_stokes(const SceneBuilder& s, uint32_t passes = 64) {
    RenderPlan plan;
    plan.width = plan.height = 32, plan.passes = passes, plan.stokes = true;
    Scene scene = compile_test_scene(s.import());
    return stokes_means(render_estimates(scene, plan));
}

// A camera that looks along -z through 5 mm of a crystal at a white lamp, and sheets on both sides of it.
SceneBuilder seen_through(const json& medium, const std::vector<json>& before,
                          const std::vector<json>& behind) {
    SceneBuilder s;
    s.rectangle(0.1, 0.1, s.black_emitter(1), at(0, 0, -0.2));
    s.perspective(1e-3, at(0, 0, 0));
    double z = -0.02;
    for (const json& sheet : before) s.rectangle(0.1, 0.1, s.surface(sheet), at(0, 0, z)), z -= 0.01;
    add_box(s, {0.1f, 0.1f, 0.005f}, crystal(s, medium), false, at(0, 0, z - 0.01));
    for (const json& sheet : behind) s.rectangle(0.1, 0.1, s.surface(sheet), at(0, 0, z - 0.03)), z -= 0.01;
    return s;
}

}  // namespace

// Radiance over n² is kept and each wave has half of it; the sum of all ways out is 1.
TEST_CASE("crystals under a white sky are as bright as that, alone and in glass") {
    for (const bool in_glass : {false, true}) {
        SceneBuilder s;
        s.environment(1);
        s.perspective(0.5, at(0, 0, 3));
        const int ball = crystal(s, calcite({1, 2, 2}), in_glass ? 2 : 0);
        s.sphere(0.4, ball, at(0, 0, 0));
        if (in_glass) {
            s.medium("glass", {{"ior", 1.7}});
            s.sphere(
                0.6,
                s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}, {"priority", 1}}),
                at(0.1, 0.3, 0));
        }
        RenderPlan plan;
        plan.width = plan.height = 24, plan.passes = 256;
        const WindowMean mean = window_mean(render_estimates(s.import(), plan));
        CAPTURE(in_glass);
        CHECK(std::fabs(mean.mean - 1) < 1e-5 + 5 * mean.standard_error);
        CHECK(mean.standard_error < 2e-3);
    }
}

// 10 mm of calcite whose axis is at 45° to its faces: the edge of a white page is seen where it is by one
// half of the light, 1.0906 mm beside by the other, which is polarized across that.
TEST_CASE("calcite doubles the edge of a page by its walk-off") {
    SceneBuilder s;
    add_box(s, {0.04f, 0.04f, 0.01f}, crystal(s, calcite({1, 0, 1})), false, at(0, 0, 0));
    s.rectangle(0.02, 0.04, s.black_emitter(1), at(-0.01, 0, -0.0051));  // x < 0 is bright
    s.orthographic(0.002, at(0, 0, 0.02));
    const StokesMeans seen = seen_stokes(s);
    // Of 4 mm, in which the ordinary image ends at 0. Light goes up along +z, and its extraordinary ray away
    // from the axis, to -x; that wave swings in the plane of the axis, along x.
    const double o = plate(no), e = plate(1.56536736), shift = -1.090607e-3;
    const double bright_o = 0.5 * 0.5 * o, bright_e = 0.5 * e * (0.002 + shift) / 0.004;
    check_stokes(seen, {bright_o + bright_e, bright_e - bright_o, 0, 0}, 2e-3, 2e-5);
}

TEST_CASE(
    "calcite between crossed polarizers: nothing along its axes, the mean of all retarders at 45 degrees") {
    const auto crossed = [](double axis) {
        return seen_through(calcite({1, 0, 0}), {polarizer(axis)}, {polarizer(axis + pi / 2)});
    };
    RenderPlan plan;
    plan.width = plan.height = 32;
    const auto seen = [&](const SceneBuilder& s) { return window_mean(render_estimates(s.import(), plan)); };
    CHECK(seen(crossed(0)).mean < 1e-6);
    CHECK(seen(crossed(pi / 2)).mean < 1e-6);
    const WindowMean between = seen(crossed(pi / 4));
    const double expected = 0.25 * 0.5 * (plate(no) + plate(ne));
    CHECK(std::fabs(between.mean - expected) < 1e-5 + 5 * between.standard_error);
    CHECK(between.standard_error < 2e-3);
    // The mean of sheets over retardances, without reflections.
    WindowMean sheets{0, 0};
    constexpr int count = 8;
    for (int i = 0; i < count; ++i) {
        SceneBuilder s;
        s.environment(1);
        s.perspective(1e-3, at(0, 0, 0));
        const std::array<json, 3> row = {polarizer(pi / 4), wave_plate(0, 2 * pi * i / count),
                                         polarizer(3 * pi / 4)};
        for (size_t k = 0; k < row.size(); ++k)
            s.rectangle(0.1, 0.1, s.surface(row[k]), at(0, 0, -0.02 - 0.01 * double(k)));
        sheets.mean += seen(s).mean / count;
    }
    CHECK(std::fabs(sheets.mean - 0.25) < 1e-4);
}

// Like tourmaline, with no reflection: what swings across the axis is absorbed.
TEST_CASE("a dichroic crystal polarizes along its axis, as far as that lies across the ray") {
    for (const double angle : {0.0, 0.6, pi / 2}) {  // of the axis from x towards z, the ray's direction
        json medium = {{"class", "uniaxial"},
                       {"ior_ordinary", 1.5},
                       {"ior_extraordinary", 1.5},
                       {"absorption_ordinary", 400},
                       {"absorption_extraordinary", 40},
                       {"axis", {std::cos(angle), 0, std::sin(angle)}}};
        SceneBuilder s = seen_through(medium, {}, {});
        const double sin2 = std::pow(std::sin(angle), 2);
        const auto passes = [](double absorption) {
            const double r = 0.04, t = std::exp(-0.005 * absorption);
            return (1 - r) * (1 - r) * t / (1 - r * r * t * t);
        };
        const double o = passes(400), e = passes(400 * sin2 + 40 * (1 - sin2));
        CAPTURE(angle);
        check_stokes(seen_stokes(s, 256), {0.5 * (o + e), 0.5 * (e - o), 0, 0}, 1e-3, 2e-5);
    }
}

TEST_CASE("polarized light through crystals: all algorithms agree in S0 to S3") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.rectangle(2, 2, s.surface(polarizer(0.4)), hanging(0, 1.9, 0));
    s.rectangle(2, 2, s.surface(wave_plate(1.1, 1.2)), hanging(0, 1.88, 0));
    const int stone = crystal(s, calcite({1, 2, 0.5}));
    s.sphere(0.6, stone, at(-0.7, -1.2, 0.2));
    add_box(s, {0.8f, 0.8f, 0.8f}, stone, false, {{0.8, -1.2, 0.1}, {0.2, 0.3, 0.1, 0.927}});
    s.sphere(0.4, s.surface({{"class", "conductor"}, {"eta", 0.2}, {"k", 3.4}, {"alpha", 0.2}}),
             at(0.2, -1.5, -1));
    Comparison c;
    c.backward = 96, c.forward = 64, c.bidirectional = 48;
    c.tolerance = 0.003, c.largest_error = 0.012;
    c.stokes = true;
    check_against_backward(s, c);
}

TEST_CASE("faces of crystals that are not smooth dielectrics are refused") {
    const auto complaint = [](const json& surface) {
        SceneBuilder s;
        s.environment(1);
        s.perspective(0.5, at(0, 0, 3));
        s.medium("crystal", calcite({1, 0, 0}));
        s.sphere(1, s.material({{"surface", surface}, {"inside", "crystal"}}), at(0, 0, 0));
        try {
            compile_test_scene(s.import());
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    for (const json& surface : {json{{"class", "dielectric"}, {"alpha", 0.2}}, {{"class", "boundary"}}})
        CHECK(complaint(surface).find(
                  "is a face of the crystal crystal; allowed there: the class dielectric") !=
              std::string::npos);
    CHECK(complaint({{"class", "dielectric"}}).empty());
}

TEST_CASE("receivers and lights within a crystal are refused") {
    const auto refused = [](const Place& camera, const Place& lamp) {
        SceneBuilder s;
        s.environment(1);
        s.perspective(0.5, camera);
        s.rectangle(0.1, 0.1, s.black_emitter(1), lamp);
        s.sphere(0.4, crystal(s, calcite({1, 2, 2})), at(0, 0, 0));
        Scene scene = compile_test_scene(s.import());
        RenderPlan plan;
        plan.width = plan.height = 4, plan.passes = 1, plan.algorithm = Algorithm::forward;
        plan.seeds = 1;
        try {
            render_estimates(scene, plan);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(refused(at(0, 0, 3), at(0, 1, 0)).empty());
    CHECK(refused(at(0, 0, 0.1), at(0, 1, 0)).find("the receiver stands within the crystal crystal") !=
          std::string::npos);
    CHECK(refused(at(0, 0, 3), at(0, 0.1, 0)).find("stands within the crystal crystal") != std::string::npos);
}
