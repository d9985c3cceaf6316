// Polarized light where it decides how bright things are: recycling films, a Rayleigh atmosphere, lamps
// behind sheets, and sheets that are turned.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/renders/sheets.h"
#include "tests/renders/stokes_means.h"
#include "tests/support/source_path.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

WindowMean mean_of(const SceneBuilder& s, Algorithm algorithm = Algorithm::backward, uint32_t passes = 512) {
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = passes, plan.algorithm = algorithm;
    return window_mean(render_estimates(s.import(), plan));
}

void check_near(const WindowMean& found, double expected, double largest_error) {
    CAPTURE(found.mean);
    CAPTURE(expected);
    CHECK(std::fabs(found.mean - expected) < 1e-5 + 5 * found.standard_error);
    CHECK(found.standard_error < largest_error * expected);
}

// A back that shines and reflects, wide planes over it, and the camera above.
SceneBuilder backlight(const json& back, const std::vector<json>& films) {
    SceneBuilder s;
    s.rectangle(1, 1, s.material({{"surface", back}, {"emission", {{"radiance", 1}}}}), at(0, 0, -1));
    for (size_t i = 0; i < films.size(); ++i)
        s.rectangle(1, 1, s.surface(films[i]), at(0, 0, -1 + 1e-4 * double(i + 1)));
    s.perspective(0.02, at(0, 0, 0));
    return s;
}

}  // namespace

// The film passes one polarization and mirrors the other. What comes back from a white reflector is tried
// anew; a mirror sends it back as it was, and behind a quarter-wave plate it is the one that passes.
TEST_CASE("a reflecting polarizer gains light by what is behind it") {
    const json film = {{"class", "reflective_polarizer"}, {"axis", 0.3}};
    for (const double r : {0.6, 0.9}) {
        CAPTURE(r);
        const json white = {{"class", "lambertian"}, {"reflectance", r}};
        check_near(mean_of(backlight(white, {polarizer(0.3)})), 0.5, 0.01);
        check_near(mean_of(backlight(white, {film})), 0.5 / (1 - r / 2), 0.01);
        const json mirror = {{"class", "conductor"}, {"reflectance", r}};
        check_near(mean_of(backlight(mirror, {film})), 0.5, 0.01);
        check_near(mean_of(backlight(mirror, {wave_plate(0.3 + pi / 4, pi / 2), film})), 0.5 * (1 + r), 0.01);
    }
    // One that is not perfect: t of what passes passes, b of the other comes back, nothing is absorbed.
    const double t = 0.9, b = 0.8, r = 0.9;
    const json real = {{"class", "reflective_polarizer"}, {"axis", 0.3}, {"pass", t}, {"block", b}};
    const WindowMean found = mean_of(backlight({{"class", "lambertian"}, {"reflectance", r}}, {real}));
    CAPTURE(found.mean);
    CHECK(found.mean > 0.5 * t / (1 - r * b / 2) * 0.99);
    CHECK(found.mean < (0.5 * t + 0.5 * (1 - b)) / (1 - r * (b + 1 - t) / 2) * 1.01);
}

// Light that comes out of a thick layer that scatters after Rayleigh and absorbs nothing is polarized along
// the horizon, more towards it (Chandrasekhar 1960, "Radiative Transfer", table XXIV). Each event gives or
// takes up to all of it: without prefer_azimuth() (shaders/features/polarization.glsl) errors are fifty times
// as large.
TEST_CASE("a Rayleigh atmosphere lit from far below is polarized towards its limb") {
    struct Direction {
        double cosine, degree;
    };
    for (const Direction& d : {Direction{1, 0}, {0.5, 0.0225}, {0.2, 0.0541}}) {
        SceneBuilder s;
        s.medium("air", {{"scattering", 6}, {"phase", {{"class", "rayleigh"}}}});
        add_box(s, {60, 60, 1}, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "air"}}), false,
                at(0, 0, 0));
        s.rectangle(60, 60, s.black_emitter(1), at(0, 0, -0.501));
        const double angle = std::acos(d.cosine);
        const glm::dvec3 view(0, std::sin(angle), -std::cos(angle)),
            from = glm::dvec3(0, 0, 0.5) - 2.0 * view;
        s.perspective(0.01, {{from.x, from.y, from.z}, {std::sin(angle / 2), 0, 0, std::cos(angle / 2)}});
        RenderPlan plan;
        plan.width = plan.height = 16, plan.passes = 1024, plan.stokes = true;
        SceneOptions options = test_options();
        options.polarization = PolarizationMode::on;
        options.varying = {"places"};
        Scene scene = compile_test_scene(s.import(), options);
        const StokesMeans stokes = stokes_means(render_estimates(scene, plan));
        const double degree = stokes[1].mean / stokes[0].mean;
        const double error = stokes[1].standard_error / stokes[0].mean;
        MESSAGE("cosine ", d.cosine, ": S1 ", degree, " +- ", error);
        CHECK(std::fabs(degree - d.degree) < 0.001 + 4 * error);
        CHECK(error < 0.002);
        CHECK(std::fabs(stokes[2].mean) < 5 * stokes[2].standard_error + 1e-5);
    }
}

TEST_CASE("a lamp behind a polarizer gives half, behind two what Malus says, by rays of both directions") {
    const auto floor = [](const std::vector<json>& sheets) {
        SceneBuilder s;
        s.rectangle(4, 4, s.lambertian(0.8), at(0, 0, -1));
        s.light({{"type", "point"}, {"intensity", 1}}, at(0, 0, 0.5));
        for (size_t i = 0; i < sheets.size(); ++i)
            s.rectangle(0.5, 0.5, s.surface(sheets[i]), at(0, 0, 0.4 - 0.02 * double(i)));
        s.perspective(0.25, at(0.3, 0, 0));  // beside the sheets, at what they light under a small angle
        return s;
    };
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        const WindowMean bare = mean_of(floor({}), algorithm);
        check_near(mean_of(floor({polarizer(0.2)}), algorithm), 0.5 * bare.mean, 0.03);
        const WindowMean two = mean_of(floor({polarizer(0), polarizer(pi / 3)}), algorithm);
        // Off the normal the axes, seen projected, are not 60 degrees apart, by some hundredths.
        CHECK(std::fabs(two.mean / bare.mean - 0.125) < 0.005 + 5 * two.standard_error / bare.mean);
    }
}

// A sheet that is turned about its normal is one whose axis is turned: at the edge of a wide field, too.
TEST_CASE("turning a sheet and turning its axis are the same") {
    constexpr double angle = 0.7;
    for (const json& sheet : {polarizer(0),
                              wave_plate(0, 1.3),
                              json{{"class", "retarder"}, {"thickness", 20000}},
                              {{"class", "lc_cell"}}}) {
        const auto seen = [&](bool sheet_turns) {
            SceneBuilder s;
            s.environment(1);
            s.perspective(1, at(0, 0, 0));
            s.rectangle(9, 9, s.surface(polarizer(0.3)), at(0, 0, -0.9));
            json turned = sheet;
            const char* axis = sheet["class"] == "lc_cell" ? "rubbing" : "axis";
            if (!sheet_turns) turned[axis] = angle;
            s.rectangle(
                9, 9, s.surface(turned),
                {{0, 0, -1},
                 {0, 0, sheet_turns ? std::sin(angle / 2) : 0, sheet_turns ? std::cos(angle / 2) : 1}});
            s.rectangle(9, 9, s.surface(polarizer(1.2)), at(0, 0, -1.1));
            RenderPlan plan;
            plan.width = plan.height = 24, plan.seeds = 2, plan.passes = 64;
            return render_estimates(s.import(), plan);
        };
        const Estimates a = seen(true), b = seen(false);
        double worst = 0;
        for (size_t i = 0; i < a.mean.size(); ++i) worst = std::max(worst, std::fabs(a.mean[i] - b.mean[i]));
        CAPTURE(sheet);
        CHECK(worst < 2e-3);
    }
}
