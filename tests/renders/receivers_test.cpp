// Receivers that measure, against closed formulas and between algorithms: illuminance, intensity, luminance;
// cameras with a lens and panoramas between algorithms alone.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

Place facing_up(double x, double y, double z) {
    return {{x, y, z}, {-0.70710678118654752, 0, 0, 0.70710678118654752}};
}

Place facing_floor(double x, double y, double z) {
    return {{x, y, z}, {0.70710678118654752, 0, 0, 0.70710678118654752}};
}

void add_receiver(SceneBuilder& s, const std::string& name, json receiver, const Place& place) {
    s.placed("receiver", std::move(receiver), place);
    s.document["nodes"].back()["name"] = name;
}

json illuminance(double width, double height, int columns = 1, int rows = 1) {
    return {{"class", "illuminance"}, {"size", {width, height}}, {"resolution", {columns, rows}}};
}

Estimates measured(Scene& scene, const std::string& receiver, Algorithm algorithm, uint32_t passes,
                   uint32_t columns = 1, uint32_t rows = 1) {
    RenderPlan plan;
    plan.width = columns, plan.height = rows, plan.receiver = receiver;
    plan.algorithm = algorithm, plan.passes = passes;
    plan.forward_paths = 4096.0 / (columns * rows);
    return render_estimates(scene, plan);
}

// Within three standard errors, which are small, or within rounding.
void check_value(const Estimates& e, double expected, double largest_error = 0.001) {
    const WindowMean seen = window_mean(e);
    CAPTURE(seen.mean);
    CAPTURE(seen.standard_error);
    CHECK(std::fabs(seen.mean - expected) < 3 * seen.standard_error + 2e-5 * expected);
    CHECK(seen.standard_error < largest_error * expected);
}

constexpr Algorithm all_algorithms[] = {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional};

}  // namespace

TEST_CASE("illuminance under a point, a disk and a rectangle is that of closed formulas") {
    struct Spot {
        double x, z, lux;
    };
    const auto check = [](const auto& add_light, const std::vector<Spot>& spots) {
        SceneBuilder s;
        add_light(s);
        for (size_t i = 0; i < spots.size(); ++i)
            add_receiver(s, std::to_string(i), illuminance(1e-3, 1e-3), facing_up(spots[i].x, 0, spots[i].z));
        Scene scene = compile_test_scene(s.import());
        for (size_t i = 0; i < spots.size(); ++i) {
            CAPTURE(spots[i].x);
            check_value(measured(scene, std::to_string(i), Algorithm::backward, 4096), spots[i].lux);
        }
    };
    // cos³ law; a floor lies where the meters are.
    check(
        [](SceneBuilder& s) {
            s.rectangle(20, 20, s.lambertian(0), facing_up(0, 0, 0));
            s.light({{"type", "point"}, {"intensity", 10000 / (4 * pi)}}, at(0, 3, 0));
        },
        {{0, 0, 88.4194},
         {1, 0, 75.4938},
         {2, 0, 50.9327},
         {3, 0, 31.2610},
         {0, 4, 19.0986},
         {0, 5, 12.0418}});
    // Coaxial and offset (configuration factors of a disk and of a rectangle, e.g. Howell's catalogue B-13).
    check(
        [](SceneBuilder& s) {
            s.shape({{"class", "disk"}, {"radius", 1}}, s.black_emitter(1000), facing_floor(0, 2, 0));
        },
        {{0, 0, 628.3185}, {1, 0, 460.0756}, {2, 0, 206.9632}, {4, 0, 33.69392}});
    check([](SceneBuilder& s) { s.rectangle(2, 1, s.black_emitter(1000), facing_floor(0, 3, 0)); },
          {{0, 0, 203.62596}, {1, 0, 172.06592}, {0, 1, 167.82869}, {2, 1, 93.93655}, {3, 0, 59.03231}});
}

TEST_CASE("a point light above a plane: mean and corner, by all algorithms, without any geometry") {
    SceneBuilder s;
    s.light({{"type", "point"}, {"intensity", 1000}}, at(0, 2, 0));
    add_receiver(s, "plane", illuminance(2, 2, 8, 8), facing_up(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : all_algorithms) {
        CAPTURE(algorithm_name(algorithm));
        const Estimates e = measured(scene, "plane", algorithm, 128, 8, 8);
        check_value(e, 201.35792);
        // Of the pixel in the corner: the mean of 1000 cos³ / 2² over it.
        double corner = 0;
        for (int i = 0; i < 20; ++i)
            for (int k = 0; k < 20; ++k) {
                const double x = 0.75 + (i + 0.5) / 80, z = 0.75 + (k + 0.5) / 80;
                corner += 2000 * std::pow(4 + x * x + z * z, -1.5) / 400;
            }
        const WindowMean seen = window_mean(e, {0, 0, 1, 1});
        CHECK(std::fabs(seen.mean - corner) < 4 * seen.standard_error + 1e-3 * corner);
    }
}

// The meter lies on the floor, under a pane of glass, beside a mirror and a rough metal.
TEST_CASE("illuminance in a room: all algorithms agree") {
    SceneBuilder s;
    add_room(s), add_lamp(s, 1.5);
    s.medium("glass", {{"ior", 1.5}});
    s.sphere(0.4, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
             at(-0.5, -1.2, 0.2));
    s.sphere(0.3, s.surface({{"class", "conductor"}, {"alpha", 0.3}}), at(0.6, -1.5, 0));
    add_receiver(s, "floor", illuminance(1.6, 1.2, 32, 24), facing_up(0, -2, 0));
    Scene scene = compile_test_scene(s.import());
    check_against_backward(
        scene,
        {.backward = 128, .forward = 32, .bidirectional = 16, .largest_error = 0.01, .receiver = "floor"});
}

TEST_CASE("illuminance in fog: all algorithms agree" * doctest::test_suite("long")) {
    SceneBuilder s;
    s.medium("fog", {{"scattering", 0.4}, {"absorption", {0.1, 0.05, 0.2}}});
    add_box(s, {4, 4, 4},
            s.material({{"surface", {{"class", "lambertian"}, {"reflectance", {0.7, 0.5, 0.3}}}},
                        {"outside", "fog"}}),
            true, at(0, 0, 0));
    add_lamp(s, 1);
    s.perspective(1.2, at(0, 0, 1.95));
    add_receiver(s, "hanging", illuminance(1.2, 0.9, 32, 24), facing_up(0.1, -0.2, 0));
    Scene scene = compile_test_scene(s.import());
    check_against_backward(
        scene,
        {.backward = 64, .forward = 64, .bidirectional = 32, .largest_error = 0.008, .receiver = "hanging"});
}

// A diffuse patch of 0.1 x 0.1 m² sends 10 cd straight on and I cos gamma elsewhere.
TEST_CASE("intensity of a patch and of a point: closed formulas, by all algorithms") {
    SceneBuilder s;
    s.rectangle(0.1, 0.1, s.black_emitter(1000), facing_floor(0.3, 1, 0));
    s.light({{"type", "point"}, {"intensity", 2}}, at(2, 1, 0));
    add_receiver(s, "far", {{"class", "intensity"}, {"resolution", {4, 7}}}, facing_up(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : all_algorithms) {
        CAPTURE(algorithm_name(algorithm));
        const double point = algorithm == Algorithm::backward ? 0 : 2;  // rays meet no point
        const Estimates e = measured(scene, "far", algorithm, 512, 4, 7);
        const double half = pi / 12;
        for (uint32_t row = 0; row < 7; ++row) {
            const double lo = std::max(row * pi / 6 - half, 0.0), hi = std::min(row * pi / 6 + half, pi / 2);
            const double end = std::min(row * pi / 6 + half, pi);
            // Mean of 10 cos gamma over the ring.
            const double wanted = lo >= pi / 2
                                      ? 0
                                      : 5 * (std::cos(lo) * std::cos(lo) - std::cos(hi) * std::cos(hi)) /
                                            (std::cos(lo) - std::cos(end));
            const WindowMean seen = window_mean(e, {0, row, 4, 1});
            CAPTURE(row);
            CHECK(std::fabs(seen.mean - wanted - point) < 4 * seen.standard_error + 1e-4);
            CHECK(seen.standard_error < 0.05);
        }
    }
}

TEST_CASE("intensity of a lamp in a tube: all algorithms agree") {
    SceneBuilder s;
    s.rectangle(0.4, 0.4, s.black_emitter({3, 2, 1}), facing_floor(0, 0.5, 0));
    s.shape({{"class", "cylinder"}, {"radius", 0.4}, {"height", 1}}, s.lambertian({0.8, 0.6, 0.4}),
            facing_up(0, 0, 0));
    s.sphere(0.15, s.surface({{"class", "conductor"}, {"alpha", 0.2}}), at(0.1, -0.2, 0));
    add_receiver(s, "far", {{"class", "intensity"}, {"resolution", {16, 13}}}, facing_up(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    check_against_backward(scene, {.width = 16,
                                   .height = 13,
                                   .backward = 512,
                                   .forward = 128,
                                   .bidirectional = 64,
                                   .largest_error = 0.02,
                                   .receiver = "far"});
}

// Nothing but light that leaves the scene brings a point behind a lens: all of it, less what its faces
// reflect.
TEST_CASE("intensity of a point behind smooth glass: the flux is that of the point") {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}});
    s.sphere(0.5, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}), at(0, 0, 0));
    s.light({{"type", "point"}, {"intensity", 1}}, at(0, 0.8, 0));
    add_receiver(s, "far", {{"class", "intensity"}, {"resolution", {8, 19}}}, facing_up(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        const Estimates e = measured(scene, "far", algorithm, 64, 8, 19);
        double flux = 0;
        for (uint32_t row = 0; row < 19; ++row) {
            const double lo = std::max(row - 0.5, 0.0) * pi / 18, hi = std::min(row + 0.5, 18.0) * pi / 18;
            flux += 2 * pi * (std::cos(lo) - std::cos(hi)) * window_mean(e, {0, row, 8, 1}).mean;
        }
        CHECK(flux == doctest::Approx(4 * pi).epsilon(0.002));
    }
}

TEST_CASE("a luminance meter shows the mean of what it aims at") {
    SceneBuilder s;
    s.rectangle(2, 2, s.black_emitter(50), at(0, 0, -1));
    s.shape({{"class", "disk"}, {"radius", 0.05}}, s.black_emitter(200), at(0, 0, -0.5));
    // The disk fills a quarter of the cone: sin² of half of half the angle over that of the cone.
    const double rim = std::asin(std::min(1.0, 2 * std::sin(0.5 * std::atan(0.1))));
    add_receiver(s, "spot", {{"class", "luminance_meter"}, {"angle", 4 * rim}}, at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    check_value(measured(scene, "spot", Algorithm::backward, 4096), 50 + 150 * 0.25, 0.003);
}

TEST_CASE("a camera with a lens and a panorama: all algorithms agree") {
    for (const json& camera : {json{{"class", "thin_lens"}, {"yfov", 0.9}, {"focus", 1.5}, {"aperture", 0.2}},
                               json{{"class", "panorama"}}}) {
        CAPTURE(camera.dump());
        SceneBuilder s;
        add_room(s), add_lamp(s, 1.5);
        s.sphere(0.3, s.surface({{"class", "conductor"}, {"alpha", 0.3}}), at(0.5, -0.5, 0));
        add_receiver(s, "lens", camera, at(0, 0, 1.5));
        Scene scene = compile_test_scene(s.import());
        check_against_backward(
            scene,
            {.backward = 64, .forward = 32, .bidirectional = 16, .largest_error = 0.01, .receiver = "lens"});
    }
}
