// Light of ray files and of beams: what it brings to a meter, against the rays of the file and closed forms,
// by each algorithm that can carry it.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/photometry/ray_file.h"
#include "host/render/automatic.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/sheets.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
constexpr Algorithm both_ways[] = {Algorithm::forward, Algorithm::bidirectional};
constexpr double h = std::numbers::sqrt2 / 2;

std::string file_of(const std::string& name) { return source_path("tests/host/rays/" + name); }

// A square meter of one pixel.
void add_meter(SceneBuilder& s, double size, const Place& place) {
    s.placed("receiver", {{"class", "illuminance"}, {"size", {size, size}}, {"resolution", {1, 1}}}, place);
}
// Across rays that go along +z, as those of the files do.
Place facing_back(double z) { return {{0, 0, z}, {1, 0, 0, 0}}; }

// lx, from independent seeds.
WindowMean measured(Scene& scene, Algorithm algorithm, uint32_t passes, double forward_paths = 4096) {
    RenderPlan plan;
    plan.width = plan.height = 1;
    plan.algorithm = algorithm, plan.passes = passes, plan.forward_paths = forward_paths;
    Moments moments;
    for (const std::vector<float>& image : render_estimates(scene, plan).images)
        moments.add(0.2126 * image[0] + 0.7152 * image[1] + 0.0722 * image[2]);
    return {moments.mean, moments.standard_error()};
}

void check_mean(const WindowMean& seen, double expected, double tolerance, double largest_error) {
    CAPTURE(expected);
    CAPTURE(seen.mean);
    CAPTURE(seen.standard_error);
    CHECK(std::abs(seen.mean - expected) < 4 * seen.standard_error + tolerance * expected);
    CHECK(seen.standard_error < largest_error * expected);
}

Scene file_scene(const std::string& file, const json& parameters, double size, double distance,
                 ColorMode color = ColorMode::automatic) {
    SceneBuilder s;
    json light = parameters;
    light["class"] = "rays", light["file"] = file_of(file);
    s.placed("light", light, at(0, 0, 0));
    add_meter(s, size, facing_back(distance));
    SceneOptions options = test_options();
    options.color = color;
    return compile_test_scene(s.import(), options);
}

}  // namespace

TEST_CASE("rays: a Lambert source of a ray file lights a meter as its rays say, and as the law") {
    const double size = 0.1, distance = 0.05, flux = 1000;
    const RayFile file = read_ray_file(file_of("own_lambert_1mm_4k.tm25ray"));
    double arriving = 0;
    for (const SourceRay& ray : file.rays) {
        const glm::dvec3 p(ray.position), d(ray.direction);
        const glm::dvec3 hit = p + d * ((1000 * distance - p.z) / d.z);
        if (d.z > 0 && std::max(std::abs(hit.x), std::abs(hit.y)) < 500 * size) arriving += ray.flux;
    }
    // Of a point of a Lambert source to a square as wide as twice its distance, before its middle.
    const double part = 4 / (2 * pi) * 2 * h * std::atan(h);
    const double spread = std::sqrt(part * (1 - part) / double(file.rays.size()));
    CHECK(std::abs(arriving / file.flux() - part) < 3 * spread);

    Scene scene = file_scene("own_lambert_1mm_4k.tm25ray", {{"flux", flux}}, size, distance);
    CHECK(scene.power == doctest::Approx(flux));
    for (const Algorithm algorithm : both_ways) {
        CAPTURE(algorithm_name(algorithm));
        check_mean(measured(scene, algorithm, 64), arriving / file.flux() * flux / (size * size), 1e-4, 1e-3);
    }
    CHECK(measured(scene, Algorithm::backward, 16).mean == 0);
}

TEST_CASE(
    "rays: wavelengths and spectra bring the luminous flux of the file, in wavelengths and in colours") {
    // V(λ) at 450, 550 and 650 nm, CIE 1931.
    const double lumens = 683 * (0.5 * 0.038 + 0.25 * 0.9949501 + 0.25 * 0.107);
    for (const char* name :
         {"own_3rays_wavelength.tm25ray", "own_3rays_zemax_spectral.sdf", "own_3rays_speos.ray"})
        for (const ColorMode color : {ColorMode::automatic, ColorMode::rgb}) {
            CAPTURE(name);
            CAPTURE(int(color));
            Scene scene = file_scene(name, json::object(), 2, 0.1, color);
            CHECK(scene.features.spectral == (color == ColorMode::automatic));
            CHECK(scene.power == doctest::Approx(lumens).epsilon(1e-5));
            for (const Algorithm algorithm : both_ways) {
                CAPTURE(algorithm_name(algorithm));
                check_mean(measured(scene, algorithm, 512, 64), lumens / 4, 1e-4, 0.01);
            }
        }
    for (const ColorMode color : {ColorMode::automatic, ColorMode::rgb}) {
        Scene two = file_scene("own_3rays_two_spectra.tm25ray", json::object(), 2, 0.1, color);
        check_mean(measured(two, Algorithm::forward, 512, 64), two.power / 4, 1e-4, 0.01);
        Scene scaled = file_scene("own_3rays_two_spectra.tm25ray", {{"flux", 40}}, 2, 0.1, color);
        check_mean(measured(scaled, Algorithm::forward, 512, 64), 10, 1e-4, 0.01);
    }
}

TEST_CASE("rays: lumens are those of the file or of `flux`, whatever the color") {
    for (const json& parameters :
         {json::object(), json{{"color", {1, 0.5, 0.1}}}, json{{"color", {{"blackbody", 3000}}}}}) {
        CAPTURE(parameters.dump());
        Scene scene = file_scene("own_3rays_lumen_extra_column_text.tm25ray", parameters, 2, 0.1);
        CHECK(scene.power == doctest::Approx(100));
        check_mean(measured(scene, Algorithm::forward, 256, 64), 25, 1e-4, 0.01);
    }
    // Watts without wavelengths are those of light of the colour.
    Scene watts = file_scene("own_3rays_flux.tm25ray",
                             {{"color", {{"wavelengths", {554, 555, 556}}, {"values", {0, 1, 0}}}}}, 2, 0.1);
    CHECK(watts.power == doctest::Approx(683).epsilon(1e-4));
    CHECK(watts.warnings.size() == 1);
}

// Through sheets a ray is let pass as a beam is whose Stokes vector is said in the scene, however the node
// stands.
TEST_CASE("rays: polarization of a file acts as that of a lamp, each ray's its own") {
    const Place askew = {{0.1, 1.9, -0.05}, {0.5, 0.1, -0.3, 0.8}};
    const TemporaryFolder folder;
    const auto seen = [&](const std::vector<RayPolarization>& rays, const json& beam, Algorithm algorithm) {
        SceneBuilder s;
        if (beam.is_null()) {
            RayFile file;
            file.unit = RayFile::Unit::watt, file.stated_lumens = 100;
            for (const RayPolarization& p : rays) {
                const float place = float(file.rays.size());
                file.rays.push_back({{place, -place, 0}, {0, 0, -1}, 1});
                file.lumens.push_back(100 / float(rays.size()));
                file.polarization.push_back(p);
            }
            const std::string path = (folder / "polarized.tm25ray").string();
            write_tm25(path, file);
            s.placed("light", {{"class", "rays"}, {"file", path}}, askew);
        } else {
            s.placed("light", {{"class", "collimated"}, {"radius", 0.01}, {"power", 100}, {"stokes", beam}},
                     askew);
        }
        // A quarter-wave plate, then a polarizer, across the way.
        const glm::dquat turn = glm::normalize(glm::dquat(0.8, 0.5, 0.1, -0.3));
        const glm::dvec3 way = turn * glm::dvec3(0, 0, -1), x = turn * glm::dvec3(1, 0, 0);
        s.rectangle(0.2, 0.2, s.surface(wave_plate(0.3, 1)), facing(askew.position + 0.1 * way, way, x));
        s.rectangle(0.2, 0.2, s.surface(polarizer(1.1)), facing(askew.position + 0.2 * way, way, x));
        add_meter(s, 0.2, facing(askew.position + 0.3 * way, -way, x));
        Scene scene = compile_test_scene(s.import());
        CHECK(scene.features.polarization);
        CHECK(scene.power == doctest::Approx(100).epsilon(1e-5));
        return measured(scene, algorithm, 16, 64).mean * 0.04;
    };
    const glm::vec3 y(0, 1, 0), diagonal(1, -1, 7);
    for (const Algorithm algorithm : both_ways) {
        CAPTURE(algorithm_name(algorithm));
        const auto alike = [&](const RayPolarization& ray, const json& stokes) {
            const double beam = seen({}, stokes, algorithm), rays = seen({ray}, {}, algorithm);
            CAPTURE(stokes.dump());
            CHECK(rays == doctest::Approx(beam).epsilon(1e-4));
            CHECK(std::abs(rays - 50) > 5);
            return rays;
        };
        alike({{1, 0, 0}, {1, 0, 0}}, {1, 1, 0, 0});
        alike({{0.8f, 0, 0}, y}, {1, -0.8, 0, 0});
        alike({{0.8f, 0, 0}, diagonal}, {1, 0, 0.8, 0});
        const double right = alike({{0, 0, 1}, {}}, {1, 0, 0, 1}),
                     left = alike({{0, 0, -1}, {}}, {1, 0, 0, -1});
        CHECK(right + left == doctest::Approx(100).epsilon(1e-4));
        CHECK(seen({{{0, 0, 1}, {}}, {{0, 0, -1}, {}}, {{0, 0, -1}, {}}, {{0, 0, -1}, {}}}, {}, algorithm) ==
              doctest::Approx(0.25 * right + 0.75 * left).epsilon(1e-4));
    }
}

TEST_CASE("collimated: within the beam the illuminance is power / (pi radius²), near and far") {
    const double radius = 0.5, power = 100, expected = power / (pi * radius * radius);
    for (const double divergence : {0.0, 1e-3})
        for (const double distance : {1.0, 10.0, 100.0}) {
            CAPTURE(divergence);
            CAPTURE(distance);
            SceneBuilder s;
            s.placed(
                "light",
                {{"class", "collimated"}, {"radius", radius}, {"divergence", divergence}, {"power", power}},
                at(0, 0, distance));
            add_meter(s, 0.4, at(0, 0, 0));
            Scene scene = compile_test_scene(s.import());
            CHECK(scene.power == doctest::Approx(power));
            for (const Algorithm algorithm :
                 {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
                CAPTURE(algorithm_name(algorithm));
                if (divergence == 0 && algorithm == Algorithm::backward)
                    CHECK(measured(scene, algorithm, 16).mean == 0);
                else
                    check_mean(measured(scene, algorithm, 64), expected, 1e-4, 2e-3);
            }
        }
}

TEST_CASE("a room lit by a beam that diverges, and a lamp: all algorithms agree") {
    SceneBuilder s;
    add_room(s);
    s.sphere(0.4, s.surface(metal(0.3)), at(-0.5, -1.2, 0.2));
    s.placed("light",
             {{"class", "collimated"},
              {"radius", 0.3},
              {"divergence", 0.3},
              {"power", 60},
              {"color", {1, 0.8, 0.5}}},
             {{0, 1.5, 0}, {-h, 0, 0, h}});
    s.light({{"type", "point"}, {"intensity", 2}}, at(0.8, 0.3, -0.5));
    s.placed("receiver", {{"class", "illuminance"}, {"size", {1.6, 1.2}}, {"resolution", {32, 24}}},
             {{0, -2, 0}, {-h, 0, 0, h}});
    s.document["nodes"].back()["name"] = "floor";
    Scene scene = compile_test_scene(s.import());
    check_against_backward(
        scene,
        {.backward = 128, .forward = 32, .bidirectional = 16, .largest_error = 0.02, .receiver = "floor"});
}

TEST_CASE("a room lit by a ray file and a beam over a glass ball: forward and bidirectional agree") {
    SceneBuilder s;
    add_room(s);
    s.medium("glass", {{"ior", 1.5}});
    s.sphere(0.4, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
             at(-0.3, -1.2, 0.1));
    s.placed("light", {{"class", "rays"}, {"file", file_of("own_lambert_1mm_4k.tm25ray")}, {"flux", 60}},
             {{0, 1.5, 0}, {h, 0, 0, h}});
    s.placed("light", {{"class", "collimated"}, {"radius", 0.5}, {"power", 20}, {"color", {1, 0.8, 0.5}}},
             {{0.4, 1.5, 0}, {-h, 0, 0, h}});
    s.light({{"type", "point"}, {"intensity", 1}}, at(0.8, 0.3, -0.5));
    s.placed("receiver", {{"class", "illuminance"}, {"size", {1.6, 1.2}}, {"resolution", {32, 24}}},
             {{0, -2, 0}, {-h, 0, 0, h}});
    s.document["nodes"].back()["name"] = "floor";
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.receiver = "floor", plan.merge_radius = 0.1f;
    plan.algorithm = Algorithm::forward, plan.passes = 128;
    const Estimates forward = render_estimates(scene, plan);
    plan.algorithm = Algorithm::bidirectional, plan.passes = 64, plan.first_seed = 101;
    check_agreement("bidirectional", render_estimates(scene, plan), forward, 0.002, 0.01);

    const FilmView view{scene.receivers.front().ref, plan.width, plan.height};
    const AlgorithmChoice choice = choose_without_pilot(test_device(), scene, {view}).value();
    CHECK(choice.algorithm == Algorithm::bidirectional);
    CHECK(scene.unmet_lights.size() == 2);
    CHECK(missed_light(scene, Algorithm::backward).find("it is left out") != std::string::npos);
    CHECK(missed_light(scene, Algorithm::forward).empty());
}

TEST_CASE("far away a beam is seen by forward rays") {
    SceneBuilder s;
    s.placed("light", {{"class", "collimated"}, {"radius", 0.1}, {"power", 5}}, at(0, 0, 0));
    s.placed("receiver", {{"class", "intensity"}, {"resolution", {4, 19}}}, at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = 4, plan.height = 19, plan.algorithm = Algorithm::forward, plan.passes = 16,
    plan.forward_paths = 64;
    const Estimates e = render_estimates(scene, plan);
    // All of it within 5 degrees of gamma = 0.
    const double solid_angle = 2 * pi * (1 - std::cos(5 * pi / 180));
    CHECK(window_mean(e, {0, 0, 4, 1}).mean == doctest::Approx(5 / solid_angle).epsilon(1e-3));
    CHECK(window_mean(e, {0, 1, 4, 18}).mean == 0);
}
