// Receivers that record rays: what they write down is the light that crosses them, and sent on from the file
// it lights another scene as it did its own.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/measure/figures.h"
#include "host/measure/measurement.h"
#include "host/measure/ray_export.h"
#include "tests/support/render_probe.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi, h = std::numbers::sqrt2 / 2;
const Place looks_up = {{0, 0, 0}, {-h, 0, 0, h}};
// A node turned and moved, at which rays are recorded and sent on.
const Place askew = {{0.1, 1.9, -0.05}, {0.5, 0.1, -0.3, 0.8}};

void name_last(SceneBuilder& s, const std::string& name) { s.document["nodes"].back()["name"] = name; }

// Two Lambert sheets of different colours over a meter of 2 x 2 m.
void add_lamps(SceneBuilder& s) {
    const json down = {h, 0, 0, h};
    s.rectangle(0.1, 0.1, s.black_emitter({4e4, 1e4, 2e3}), {{0, 2, 0}, down});
    s.rectangle(0.05, 0.1, s.black_emitter({2e3, 1e4, 5e4}), {{0.12, 2, 0.05}, down});
}
void add_meter(SceneBuilder& s, int pixels = 4) {
    s.placed("receiver", {{"class", "illuminance"}, {"size", {2, 2}}, {"resolution", {pixels, pixels}}},
             looks_up);
    name_last(s, "floor");
}

struct Measured {
    std::vector<Readings> meters;
    AlgorithmChoice choice;
    const Readings& at(const std::string& name) const {
        return *std::find_if(meters.begin(), meters.end(),
                             [&](const Readings& r) { return r.meter.name == name; });
    }
};

Measured measure(Scene& scene, uint64_t passes, Algorithm algorithm = Algorithm::automatic,
                 double forward_paths = 1) {
    std::vector<const Receiver*> receivers;
    for (const Receiver& receiver : scene.receivers) receivers.push_back(&receiver);
    RenderSettings settings;
    settings.algorithm = algorithm, settings.forward_paths = forward_paths;
    MeasurementRun run(test_device(), scene, receivers, settings);
    REQUIRE(run.add({0, passes}, [] { return false; }));
    return {run.measurement().meters, run.measurement().choice};
}

Interval flux_of(const Readings& readings) { return figures_of(readings, {})[0].interval; }

// Pixels of both in units of the intervals of both; colours, too.
void check_same(const Readings& a, const Readings& b, double widest) {
    const auto x = luminous_values(a), y = luminous_values(b);
    for (size_t i = 0; i < x[0].size(); ++i) {
        Series p, q;
        for (uint32_t k = 0; k < replicates; ++k) p.push_back(x[k][i]), q.push_back(y[k][i]);
        const Interval u = mean_interval(p), v = mean_interval(q);
        const double half = std::hypot(u.high - u.value, v.high - v.value);
        CAPTURE(i);
        CAPTURE(u.value);
        CAPTURE(v.value);
        CHECK(std::abs(u.value - v.value) < 2 * half);
        CHECK(half < widest * u.value);
    }
    const auto figures = figures_of(a, {}), others = figures_of(b, {});
    for (size_t i = 0; i < figures.size(); ++i)
        if (figures[i].name == "x" || figures[i].name == "y")
            CHECK(figures[i].interval.value == doctest::Approx(others[i].interval.value).epsilon(0.02));
}

Scene compile(const SceneBuilder& s, ColorMode color) {
    SceneOptions options = test_options();
    options.color = color;
    return compile_test_scene(s.import(), options);
}

}  // namespace

TEST_CASE("what leaves a sphere round lamps is recorded, and lights another scene from its file") {
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
        CAPTURE(int(color));
        SceneBuilder s;
        add_lamps(s);
        add_meter(s);
        s.placed("receiver", {{"class", "rays"}, {"radius", 0.4}}, askew);
        name_last(s, "recorder");
        Scene scene = compile(s, color);
        const Measured lamps = measure(scene, color == ColorMode::rgb ? 64 : 256);
        CHECK(lamps.choice.algorithm == Algorithm::bidirectional);
        const Readings& recorder = lamps.at("recorder");
        const Interval flux = flux_of(recorder);
        CHECK(std::abs(flux.value - scene.power) < 1.5 * (flux.high - flux.value) + 1e-4 * scene.power);
        const RayFile file = recorded_rays(recorder).value();
        CHECK(file.stated_lumens == doctest::Approx(flux.value).epsilon(1e-6));
        CHECK((file.unit == RayFile::Unit::watt) == (color == ColorMode::spectral));
        for (const SourceRay& ray : file.rays) {
            if (std::abs(glm::length(ray.position) - 400) > 0.01f) FAIL("off the sphere");
            if (glm::dot(ray.position, ray.direction) < 0) FAIL("inwards");
        }

        const TemporaryFolder folder;
        const std::string path = (folder / "lamps.tm25ray").string();
        write_tm25(path, file);
        SceneBuilder again;
        again.placed("light", {{"class", "rays"}, {"file", path}}, askew);
        add_meter(again);
        Scene copy = compile(again, color);
        CHECK(copy.power == doctest::Approx(flux.value).epsilon(1e-3));
        check_same(lamps.at("floor"), measure(copy, 256).at("floor"), 0.1);
    }
}

TEST_CASE("a rectangle records what comes from its front, whatever the algorithm; light goes on") {
    SceneBuilder s;
    add_lamps(s);
    s.rectangle(2, 2, s.lambertian(0.8), looks_up);  // sends light back
    add_meter(s);
    Scene plain = compile_test_scene(s.import());
    s.placed("receiver", {{"class", "rays"}, {"size", {1, 1.5}}, {"resolution", {3, 2}}},
             {{0.2, 1, 0}, {-h, 0, 0, h}});
    name_last(s, "recorder");
    Scene scene = compile_test_scene(s.import());
    // Backward rays need no recorder: what its picture must be.
    const Measured backward = measure(scene, 256, Algorithm::backward);
    CHECK_FALSE(recorded_rays(backward.at("recorder")).has_value());
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        const Measured measured = measure(scene, 64, algorithm, 1024);
        check_same(backward.at("recorder"), measured.at("recorder"), 0.05);
        check_same(measure(plain, 64, algorithm, 1024).at("floor"), measured.at("floor"), 0.05);
        const RayFile file = recorded_rays(measured.at("recorder")).value();
        for (const SourceRay& ray : file.rays) {
            const glm::vec3 p = glm::abs(ray.position);
            if (p.x > 500.1f || p.y > 750.1f || p.z > 0.01f) FAIL("off the rectangle");
            if (ray.direction.z > 0) FAIL("from behind");
        }
    }
}

TEST_CASE("beyond the limit an even sample is kept, with the flux that was measured") {
    SceneBuilder s;
    add_lamps(s);
    s.placed("receiver", {{"class", "rays"}, {"size", {2, 2}}, {"resolution", {2, 1}}, {"limit", 4000}},
             {{0.5, 0, 0}, {-h, 0, 0, h}});
    Scene scene = compile_test_scene(s.import());
    const Measured measured = measure(scene, 64, Algorithm::forward, 16384);
    const Readings& recorder = measured.meters.front();
    CHECK(recorder.rays.crossings.size() == 4000);
    CHECK_FALSE(recorder.rays.is_whole());
    const RayFile file = recorded_rays(recorder).value();
    CHECK(file.flux() == doctest::Approx(flux_of(recorder).value).epsilon(1e-5));
    // The left pixel's part of the flux, by the sample and by all light.
    double left = 0, squares = 0;
    for (const SourceRay& ray : file.rays) left += ray.position.x < 0 ? ray.flux : 0.0f;
    for (const SourceRay& ray : file.rays) squares += double(ray.flux) * ray.flux;
    const auto values = luminous_values(recorder);
    Series a, b;
    for (const auto& v : values) a.push_back(v[0]), b.push_back(v[1]);
    const double part = mean_of(a) / (mean_of(a) + mean_of(b)), error = std::sqrt(squares) / file.flux();
    CHECK(error < 0.05);
    CHECK(std::abs(left / file.flux() - part) < 4 * 0.5 * error);
    CHECK(std::abs(part - 0.5) > 4 * error);
}
