// Lamps of photometric files: what they light a floor with, against the intensities of the file and between
// algorithms.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/measure/figures.h"
#include "host/measure/measurement.h"
#include "host/photometry/intensity_distribution.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr Algorithm all_algorithms[] = {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional};

// The xy plane of a node that is turned so lies flat and faces up; one that is turned the other way shines
// down.
constexpr double h = std::numbers::sqrt2 / 2;

std::string file_of(const std::string& name) { return source_path("tests/host/photometry/" + name); }

void add_floor_meter(SceneBuilder& s, const std::string& name, double x, double z, double size) {
    s.placed("receiver", {{"class", "illuminance"}, {"size", {size, size}}, {"resolution", {1, 1}}},
             {{x, 0, z}, {-h, 0, 0, h}});
    s.document["nodes"].back()["name"] = name;
}

// Of a receiver that sees about the same everywhere: in a film of several pixels a pass has as many samples.
WindowMean measured(Scene& scene, const std::string& receiver, Algorithm algorithm, uint32_t passes) {
    RenderPlan plan;
    plan.width = plan.height = 8, plan.receiver = receiver;
    plan.algorithm = algorithm, plan.passes = passes;
    plan.forward_paths = 64;
    return window_mean(render_estimates(scene, plan));
}

// What all receivers, of one pixel each, read of the same rays.
std::vector<WindowMean> all_measured(Scene& scene, Algorithm algorithm) {
    std::vector<const Receiver*> receivers;
    for (const Receiver& receiver : scene.receivers) receivers.push_back(&receiver);
    RenderSettings settings;
    settings.algorithm = algorithm, settings.forward_paths = 1024;
    MeasurementRun run(test_device(), scene, receivers, settings);
    REQUIRE(run.add({0, 32 * replicates}, [] { return false; }));
    std::vector<WindowMean> means;
    for (const Readings& readings : run.measurement().meters) {
        Moments moments;
        for (const auto& replicate : luminous_values(readings)) moments.add(replicate[0]);
        means.push_back({moments.mean, moments.standard_error()});
    }
    return means;
}

// lx on a floor at y = 0, whose normal is +y, mean over a square. `frame`: the lamp's x, y, z in the world.
double floor_illuminance(const IntensityDistribution& d, const glm::dmat3& frame, const glm::dvec3& lamp,
                         double x, double z, double size) {
    double sum = 0;
    const int n = 24;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const glm::dvec3 point(x + ((i + 0.5) / n - 0.5) * size, 0, z + ((k + 0.5) / n - 0.5) * size),
                way = point - lamp;
            const double distance = glm::length(way);
            sum += d.intensity(way / distance * frame) * lamp.y / (distance * distance * distance);
        }
    return sum / (n * n);
}

}  // namespace

TEST_CASE("a photometric lamp lights a floor as its file says, in every algorithm, hung and turned") {
    struct Case {
        const char* file;
        json parameters;
        double turn;  // about the lamp's own axis, towards C90
        double factor;
    };
    for (const Case& c : std::vector<Case>{{"own_asym_0_360.ies", json::object(), 0, 1},
                                           {"own_asym_0_360.ies", {{"turn", 0.8}, {"scale", 2}}, 0.8, 2},
                                           {"own_isym4_asym.ldt", {{"flux", 1998.7298}}, 0, 2},
                                           {"own_lambert_type_b_quarter.ies", json::object(), 0, 1}}) {
        INFO(std::string(c.file), " ", c.parameters.dump());
        const IntensityDistribution d = read_photometric_file(file_of(c.file));
        const glm::dvec3 place(0.3, 2.5, -0.2);
        // -z looks down: x stays, y lies towards -z.
        const glm::dvec3 x(1, 0, 0), y(0, 0, -1), z(0, 1, 0);
        const glm::dmat3 frame(std::cos(c.turn) * x + std::sin(c.turn) * y,
                               std::cos(c.turn) * y - std::sin(c.turn) * x, z);
        SceneBuilder s;
        s.rectangle(20, 20, s.lambertian(0), {{0, 0, 0}, {-h, 0, 0, h}});
        json lamp = c.parameters;
        lamp["class"] = "ies", lamp["file"] = file_of(c.file), lamp["point"] = true;
        s.placed("light", lamp, {{place.x, place.y, place.z}, {-h, 0, 0, h}});
        const std::vector<glm::dvec2> spots = {{0.3, -0.2}, {1.5, -0.2}, {0.3, -2}, {-2, 1.5}, {1, 2}};
        for (size_t i = 0; i < spots.size(); ++i)
            add_floor_meter(s, std::to_string(i), spots[i].x, spots[i].y, 0.4);
        Scene scene = compile_test_scene(s.import());
        CHECK(scene.power == doctest::Approx(d.flux() * c.factor).epsilon(1e-5));
        for (const Algorithm algorithm : all_algorithms) {
            const std::vector<WindowMean> all = all_measured(scene, algorithm);
            for (size_t i = 0; i < spots.size(); ++i) {
                CAPTURE(i);
                CAPTURE(algorithm_name(algorithm));
                const double expected =
                    c.factor * floor_illuminance(d, frame, place, spots[i].x, spots[i].y, 0.4);
                const WindowMean& seen = all.at(i);
                CAPTURE(expected);
                CAPTURE(seen.mean);
                CHECK(std::fabs(seen.mean - expected) < 4 * seen.standard_error + 3e-4 * expected);
                CHECK(seen.standard_error < 0.02 * expected);
            }
        }
    }
}

TEST_CASE("far away a photometric lamp has the intensities of its file") {
    const IntensityDistribution d = read_photometric_file(file_of("own_asym_0_360.ies"));
    SceneBuilder s;
    s.placed("light", {{"class", "ies"}, {"file", file_of("own_asym_0_360.ies")}}, at(0, 0, 0));
    s.placed("receiver", {{"class", "intensity"}, {"resolution", {4, 19}}}, at(0, 0, 0));
    s.document["nodes"].back()["name"] = "far";
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = 4, plan.height = 19, plan.receiver = "far";
    plan.algorithm = Algorithm::forward, plan.passes = 512, plan.forward_paths = 64;
    const Estimates e = render_estimates(scene, plan);
    for (uint32_t column = 0; column < 4; ++column)
        for (uint32_t row = 2; row < 8; row += 5) {  // gamma = 20, 70: means over 10 x 90 degrees
            double sum = 0, weights = 0;
            for (int i = 0; i < 40; ++i)
                for (int k = 0; k < 40; ++k) {
                    const double c = 90.0 * column + ((i + 0.5) / 40 - 0.5) * 90,
                                 gamma = 10.0 * row + ((k + 0.5) / 40 - 0.5) * 10;
                    const double weight = std::sin(gamma * std::numbers::pi / 180);
                    sum += weight * d.intensity(c, gamma), weights += weight;
                }
            const WindowMean seen = window_mean(e, {column, row, 1, 1});
            CAPTURE(column);
            CAPTURE(row);
            CAPTURE(seen.mean);
            CHECK(std::fabs(seen.mean - sum / weights) < 4.5 * seen.standard_error + 1e-3 * sum / weights);
            CHECK(seen.standard_error < 0.03 * sum / weights);
        }
}

TEST_CASE("a room lit by a photometric lamp: all algorithms agree") {
    SceneBuilder s;
    add_room(s);
    s.sphere(0.4, s.surface({{"class", "conductor"}, {"alpha", 0.3}}), at(-0.5, -1.2, 0.2));
    s.placed(
        "light",
        {{"class", "ies"}, {"file", file_of("own_asym_0_360.ies")}, {"turn", 1.0}, {"color", {1, 0.8, 0.5}}},
        {{0, 1.5, 0}, {-h, 0, 0, h}});
    s.placed("light", {{"class", "ies"}, {"file", file_of("own_lambert_type_b.ies")}, {"scale", 0.3}},
             {{-1, 1, -1}, {-h, 0, 0, h}});
    s.placed("receiver", {{"class", "illuminance"}, {"size", {1.6, 1.2}}, {"resolution", {32, 24}}},
             {{0, -2, 0}, {-h, 0, 0, h}});
    s.document["nodes"].back()["name"] = "floor";
    Scene scene = compile_test_scene(s.import());
    check_against_backward(
        scene,
        {.backward = 128, .forward = 32, .bidirectional = 16, .largest_error = 0.02, .receiver = "floor"});
}

// Close to it, a panel of 1 x 0.5 m with intensities of I cos gamma is a rectangle of even luminance I / A.
TEST_CASE("the luminous opening of a photometric lamp is where its light comes from") {
    const TemporaryFolder folder;
    const auto lamp = [&](const char* file, const char* sizes) {
        std::string text = read_text(file_of("own_lambert_iesna91_one_per_line.ies"));
        const size_t at = text.find("0.0 0.0 0.0");
        REQUIRE(at != std::string::npos);
        write_text(folder / file, text.replace(at, 11, sizes));
        return (folder / file).string();
    };
    const std::string panel = lamp("panel.ies", "0.5 1 0"), disk = lamp("disk.ies", "-2 0 0");
    const auto check = [&](const json& light, double distance, double x, double expected) {
        INFO(light.dump());
        SceneBuilder s;
        s.rectangle(20, 20, s.lambertian(0), {{0, 0, 0}, {-h, 0, 0, h}});
        s.placed("light", light, {{0, distance, 0}, {-h, 0, 0, h}});
        add_floor_meter(s, "floor", x, 0, 1e-3);
        Scene scene = compile_test_scene(s.import());
        for (const Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
            const WindowMean seen = measured(scene, "floor", algorithm, 16);
            CAPTURE(algorithm_name(algorithm));
            CAPTURE(expected);
            CAPTURE(seen.mean);
            CHECK(std::fabs(seen.mean - expected) <
                  4 * seen.standard_error + 2e-3 * expected);  // steps of 5 degrees
            CHECK(seen.standard_error < 0.01 * expected);
        }
    };
    // Rectangle of 1 m along x and 0.5 m, seen from below its centre: four configuration factors of corners.
    const auto corner = [](double a, double b) {
        const double u = std::sqrt(1 + a * a), v = std::sqrt(1 + b * b);
        return (a / u * std::atan(b / u) + b / v * std::atan(a / v)) / (2 * std::numbers::pi);
    };
    const double distance = 0.4;
    check({{"class", "ies"}, {"file", panel}}, distance, 0,
          4 * corner(0.5 / distance, 0.25 / distance) * std::numbers::pi * 1000 / 0.5);
    check({{"class", "ies"}, {"file", panel}, {"point", true}}, distance, 0, 1000 / (distance * distance));
    // A disk of radius 1 m, 1000 cd: 1000 / pi cd/m²; 2 m below its centre and 1 m aside.
    check({{"class", "ies"}, {"file", disk}}, 2, 0, 628.3185 / std::numbers::pi);
    check({{"class", "ies"}, {"file", disk}}, 2, 1, 460.0756 / std::numbers::pi);
}

// The same panel, 1000 cd straight down, as the rectangle of its node: 2000 cd/m² from all sides, and what it
// reflects.
TEST_CASE("a luminous opening that is seen shines as its file says, and all algorithms agree on it") {
    const auto hang = [](SceneBuilder& s, json geometry, double turn) {
        s.placed("light",
                 {{"class", "ies"},
                  {"file", file_of("own_lambert_iesna91_one_per_line.ies")},
                  {"turn", turn},
                  {"opening", true}},
                 {{0, 1.2, 0}, {-h, 0, 0, h}});
        s.document["nodes"].back()["extensions"]["ETD_optics"]["geometry"] = std::move(geometry);
    };
    SceneBuilder s;
    add_room(s);
    s.sphere(0.4, s.surface({{"class", "conductor"}, {"alpha", 0}}), at(-0.5, -1.2, 0.2));
    hang(s, {{"class", "rectangle"}, {"size", {1, 0.5}}, {"material", s.lambertian(0.5)}}, 0.7);
    s.placed("receiver", {{"class", "luminance_meter"}, {"angle", 0.02}}, {{0.1, -0.5, 0.1}, {h, 0, 0, h}});
    s.document["nodes"].back()["name"] = "straight up";
    Scene scene = compile_test_scene(s.import());
    CHECK(scene.power == doctest::Approx(1000 * std::numbers::pi).epsilon(0.002));
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional}) {
        const WindowMean seen = measured(scene, "straight up", algorithm, 4);
        const double reflected = seen.mean - 2000;  // of what the room sends up, with some hundred lx
        CHECK(reflected > 0);
        CHECK(reflected < 100);
    }
    check_against_backward(scene,
                           {.backward = 256, .forward = 64, .bidirectional = 16, .largest_error = 0.03});

    const auto refused = [&](const json& geometry, const std::string& what) {
        SceneBuilder bad;
        add_room(bad);
        bad.surface({{"class", "absorber"}});
        hang(bad, geometry, 0);
        if (geometry.is_null()) bad.document["nodes"].back()["extensions"]["ETD_optics"].erase("geometry");
        try {
            compile_test_scene(bad.import());
            FAIL("compiled: ", what);
        } catch (const Error& e) {
            CAPTURE(e.what());
            CHECK(std::string(e.what()).find(what) != std::string::npos);
        }
    };
    refused(nullptr, "the node has no geometry; allowed: true where the node has a rectangle or disk");
    refused({{"class", "sphere"}, {"radius", 1}, {"material", 0}}, "the node's geometry is a sphere");
}
