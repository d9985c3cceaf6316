// Meters on the surfaces of meshes: illuminance and exitance of both sides, against closed forms and between
// algorithms; light goes on as if they were not there.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "host/error.h"
#include "host/measure/figures.h"
#include "host/measure/measurement.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi, h = std::numbers::sqrt2 / 2;
constexpr Algorithm all_algorithms[] = {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional};
enum Part { front_in, back_in, front_out, back_out };

// Puts a meter on the node that was added last.
void watch_last(SceneBuilder& s, const json& receiver = {{"class", "surface"}}) {
    s.document["nodes"].back()["extensions"]["ETD_optics"]["receiver"] = receiver;
}

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    // Counter-clockwise.
    void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
        const auto first = uint32_t(positions.size());
        positions.insert(positions.end(), {a, b, c, d});
        for (const uint32_t i : {0, 1, 2, 0, 2, 3}) indices.push_back(first + i);
    }
    void add_to(SceneBuilder& s, int material, const Place& place = at(0, 0, 0)) const {
        s.mesh(positions, indices, material, place);
    }
};

// 2 x 2 m in n x n squares around the origin, facing +y.
Mesh floor_mesh(int n, double size = 2) {
    Mesh mesh;
    const auto point = [&](int x, int z) {
        return glm::vec3(size * x / n - size / 2, 0, size * z / n - size / 2);
    };
    for (int z = 0; z < n; ++z)
        for (int x = 0; x < n; ++x)
            mesh.quad(point(x, z), point(x, z + 1), point(x + 1, z + 1), point(x + 1, z));
    return mesh;
}

// Between two polar angles, facing inwards.
Mesh sphere_mesh(double radius, double from, double to, int rings, int segments = 64) {
    Mesh mesh;
    const auto point = [&](int ring, int segment) {
        const double theta = from + (to - from) * ring / rings, phi = 2 * pi * segment / segments;
        return glm::vec3(radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                             std::sin(theta) * std::sin(phi)));
    };
    for (int r = 0; r < rings; ++r)
        for (int i = 0; i < segments; ++i)
            mesh.quad(point(r, i), point(r + 1, i), point(r + 1, i + 1), point(r, i + 1));
    return mesh;
}

std::vector<ReadingsPart> measure(Scene& scene, Algorithm algorithm, uint64_t passes, double forward_paths) {
    const auto found = std::find_if(scene.receivers.begin(), scene.receivers.end(),
                                    [](const Receiver& r) { return r.info->on_surface; });
    REQUIRE(found != scene.receivers.end());
    RenderSettings settings;
    settings.algorithm = algorithm, settings.forward_paths = forward_paths;
    MeasurementRun run(test_device(), scene, {&*found}, settings);
    REQUIRE(run.add({0, passes}, [] { return false; }));
    return parts_of(run.measurement().meters.front());
}

Interval figure(const ReadingsPart& part, const std::string& name) {
    for (const Figure& f : figures_of(part.readings, {}))
        if (f.name == name) return f.interval;
    FAIL(name);
    return {};
}

void check_near(const Interval& seen, double expected, double tolerance, double widest) {
    const double half = seen.high - seen.value;
    CAPTURE(seen.value);
    CAPTURE(half);
    CAPTURE(expected);
    CHECK(std::abs(seen.value - expected) < 1.6 * half + tolerance * expected);
    CHECK(half <= widest * expected);
}

}  // namespace

TEST_CASE("a mesh under a point lamp has the lamp's illuminance on its front, and sends on its part of it") {
    SceneBuilder s;
    floor_mesh(4).add_to(s, s.lambertian(0.3));
    watch_last(s);
    s.light({{"type", "point"}, {"intensity", 1000}}, at(0, 2, 0));
    Scene scene = compile_test_scene(s.import());
    CHECK(scene.receivers[0].watched.count == 32);
    CHECK(scene.receivers[0].watched.area == doctest::Approx(4));
    for (const Algorithm algorithm : all_algorithms) {
        CAPTURE(algorithm_name(algorithm));
        const auto parts = measure(scene, algorithm, 256, 64);
        REQUIRE(parts.size() == 4);
        check_near(figure(parts[front_in], "flux"), 805.43168, 1e-4, 0.01);
        check_near(figure(parts[front_out], "flux"), 0.3 * 805.43168, 1e-4, 0.01);
        CHECK(figure(parts[back_in], "flux").value == 0);
        CHECK(figure(parts[back_out], "flux").value == 0);
        for (const Part part : {front_in, front_out}) {
            const Readings& readings = parts[part].readings;
            const auto values = luminous_values(readings);
            for (size_t t = 0; t < 32; ++t) {
                Series series;
                for (const auto& v : values) series.push_back(v[t]);
                // At the centre; over a triangle of 0.5 m it varies by little that is not linear.
                const glm::dvec3 p(readings.meter.places[t].position);
                const double there = 1000 * 2 / std::pow(glm::dot(p, p) + 4, 1.5);
                check_near(mean_interval(series), (part == front_in ? 1 : 0.3) * there, 0.01, 0.1);
            }
        }
    }
}

TEST_CASE("a black sphere of triangles round an isotropic lamp has phi / S within, nothing outside") {
    SceneBuilder s;
    sphere_mesh(0.5, 0, pi, 16, 32).add_to(s, s.surface({{"class", "absorber"}}));
    watch_last(s);
    s.light({{"type", "point"}, {"intensity", 1000 / (4 * pi)}}, at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    const double expected = 1000 / double(scene.receivers[0].watched.area);
    for (const Algorithm algorithm : all_algorithms) {
        CAPTURE(algorithm_name(algorithm));
        const auto parts = measure(scene, algorithm, 64, 4);
        check_near(figure(parts[front_in], "mean"), expected, 1e-4, 0.01);
        for (const Part part : {back_in, front_out, back_out})
            CHECK(figure(parts[part], "flux").value < 1e-4);
    }
}

TEST_CASE("the wall of an integrating sphere has the closed value, and sends on rho of it") {
    const double rho = 0.95, port = 11.4783 * pi / 180, f = 0.01;
    SceneBuilder s;
    sphere_mesh(0.5, port, pi, 16, 32).add_to(s, s.lambertian(rho));
    watch_last(s);
    sphere_mesh(0.5, 0, port, 2, 32).add_to(s, s.surface({{"class", "absorber"}}));
    s.light({{"type", "point"}, {"intensity", 1000 / (4 * pi)}}, at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    CHECK(1000 / pi / (1 - rho * (1 - f)) == doctest::Approx(5349.746).epsilon(1e-6));
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward}) {
        CAPTURE(algorithm_name(algorithm));
        const auto parts = measure(scene, algorithm, 16, 1);
        // The polyhedron within the sphere has a little less of a surface.
        const double ratio = double(scene.receivers[0].watched.area) / (pi * (1 - f));
        CHECK(ratio > 0.985);
        check_near(figure(parts[front_in], "mean"), 5349.746 / ratio, 4e-3, 0.01);
        const double in = figure(parts[front_in], "flux").value, out = figure(parts[front_out], "flux").value;
        CHECK(out / in == doctest::Approx(rho).epsilon(algorithm == Algorithm::forward ? 2e-4 : 3e-3));
    }
}

TEST_CASE("a pane of glass lets through, reflects and receives what its closed values say") {
    SceneBuilder s;
    floor_mesh(2, 1).add_to(s, s.surface({{"class", "thin_dielectric"}, {"ior", 1.49}}));
    watch_last(s);
    s.placed("light", {{"class", "collimated"}, {"radius", 0.2}, {"power", 100}}, {{0, 1, 0}, {-h, 0, 0, h}});
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        const auto parts = measure(scene, algorithm, 64, 64);
        check_near(figure(parts[front_in], "flux"), 100, 1e-4, 1e-3);
        check_near(figure(parts[back_out], "flux"), 92.5437, 1e-4, 0.02);
        check_near(figure(parts[front_out], "flux"), 100 - 92.5437, 1e-3, 0.1);
        CHECK(figure(parts[back_in], "flux").value == 0);
    }
}

TEST_CASE("light that passes two filters of one mesh straight on is read at each") {
    Mesh sheets;
    for (const float y : {0.0f, -0.3f}) sheets.quad({-1, y, -1}, {-1, y, 1}, {1, y, 1}, {1, y, -1});
    SceneBuilder s;
    sheets.add_to(s, s.surface({{"class", "color_filter"}, {"transmittance", 0.5}}));
    watch_last(s);
    s.placed("light", {{"class", "collimated"}, {"radius", 0.2}, {"power", 100}}, {{0, 1, 0}, {-h, 0, 0, h}});
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        const auto parts = measure(scene, algorithm, 64, 64);
        check_near(figure(parts[front_in], "flux"), 150, 1e-4, 1e-3);
        check_near(figure(parts[back_out], "flux"), 75, 1e-4, 1e-3);
        CHECK(figure(parts[front_out], "flux").value < 1e-4);
        CHECK(figure(parts[back_in], "flux").value < 1e-4);
    }
}

TEST_CASE("a lamp's own exitance is pi L, by all algorithms, and through holes of it") {
    SceneBuilder s;
    floor_mesh(2).add_to(s, s.black_emitter(1000));
    watch_last(s);
    s.rectangle(2, 2, s.lambertian(0.5), {{0, 1, 0}, {h, 0, 0, h}});
    Scene scene = compile_test_scene(s.import());
    for (const Algorithm algorithm : all_algorithms) {
        CAPTURE(algorithm_name(algorithm));
        const auto parts = measure(scene, algorithm, 256, 64);
        check_near(figure(parts[front_out], "mean"), 1000 * pi, 1e-4, 0.01);
        CHECK(figure(parts[back_out], "flux").value == 0);
        CHECK(figure(parts[front_in], "flux").value > 100);
    }
}

// A room of all kinds of surfaces, with a body of glass that has the meter.
Scene glass_in_room(bool watched) {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.5, 1, 2}}});
    add_box(s, {3, 3, 3}, s.lambertian({0.6, 0.5, 0.4}), true, at(0, 0, 0));
    s.rectangle(1.6, 1.6, s.black_emitter(40), {{0.3, 1.45, 0}, {h, 0, 0, h}});
    add_box(s, {1, 0.8, 0.9},
            s.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.5}}}, {"inside", "glass"}}), false,
            {{0.1, -0.6, 0}, {0.1, 0.3, 0.05, 0.94}});
    if (watched) watch_last(s);
    s.rectangle(1, 1, s.surface(metal(0.2)), {{-1, -0.4, 0}, {0, h, 0, h}});
    s.placed("receiver", {{"class", "illuminance"}, {"size", {2, 2}}, {"resolution", {2, 2}}},
             {{0, -1.5, 0}, {-h, 0, 0, h}});
    s.document["nodes"].back()["name"] = "floor";
    return compile_test_scene(s.import());
}

TEST_CASE("both sides of a body of glass in a room: all algorithms and schedules agree") {
    Scene scene = glass_in_room(true);
    const Receiver& meter = scene.receivers[0];
    REQUIRE(meter.info->on_surface);
    CHECK(meter.columns == 4);
    CHECK(meter.rows == 12);
    RenderPlan plan;
    plan.width = meter.columns, plan.height = meter.rows, plan.receiver = meter.name, plan.seeds = 16;
    plan.passes = 4096;
    const Estimates expected = render_estimates(scene, plan);
    plan.forward_paths = 64, plan.passes = 128, plan.merge_radius = 0.02f;
    for (const Algorithm algorithm : {Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        plan.algorithm = algorithm, plan.first_seed += 100;
        const Estimates e = render_estimates(scene, plan);
        const Agreement pixels = agreement(e, expected, 1);
        MESSAGE(std::string(algorithm_name(algorithm)), ": ", describe(pixels));
        CHECK(pixels.holds);
        CHECK(pixels.rms_z < 1.2);
        for (uint32_t part = 0; part < 4; ++part) {  // 12 triangles fill 3 rows of 4
            const Window window{0, 3 * part, 4, 3};
            const WindowMean ours = window_mean(e, window), theirs = window_mean(expected, window);
            const double error = std::hypot(ours.standard_error, theirs.standard_error);
            CAPTURE(part);
            CAPTURE(ours.mean);
            CAPTURE(theirs.mean);
            CHECK(std::abs(ours.mean - theirs.mean) < 4 * error + 1e-3 * theirs.mean);
            CHECK(error < 0.01 * theirs.mean);
        }
    }
    plan.seeds = 1, plan.forward_paths = 20;
    plan.algorithm = Algorithm::bidirectional;
    const FilmState fused = render_film(scene, plan, Schedule::fused, {2, 2});
    for (const Schedule schedule : {Schedule::wavefront, Schedule::by_class}) {
        const FilmState other = render_film(scene, plan, schedule, {3, 1});
        CHECK(std::memcmp(fused.pixels.data(), other.pixels.data(), fused.pixels.size() * sizeof(ExactSum)) ==
              0);
    }
}

TEST_CASE("light passes a meter on a surface; the balance of power knows nothing of it") {
    Scene plain = glass_in_room(false), watched = glass_in_room(true);
    const auto run = [](Scene& scene) {
        std::vector<const Receiver*> receivers;
        for (const Receiver& r : scene.receivers) receivers.push_back(&r);
        RenderSettings settings;
        settings.algorithm = Algorithm::forward;
        settings.forward_paths = 2e4 / (scene.receivers.size() > 1 ? 52 : 4);
        MeasurementRun measurement(test_device(), scene, receivers, settings);
        REQUIRE(measurement.add({0, 256}, [] { return false; }));
        return measurement.measurement();
    };
    const Measurement a = run(plain), b = run(watched);
    const Interval x = figures_of(a.meters.back(), {})[0].interval,
                   y = figures_of(b.meters.back(), {})[0].interval;
    CHECK(std::abs(x.value - y.value) < 1.5 * std::hypot(x.high - x.value, y.high - y.value));
    CHECK(x.high - x.value < 0.01 * x.value);
    for (const Measurement* m : {&a, &b}) {
        const RenderCounters& c = m->counters;
        CHECK(std::abs(c.emitted - c.absorbed - c.forward_escaped - c.forward_depth_limit_lost - c.roulette) <
              1e-4 * c.emitted);
    }
    CHECK(a.counters.absorbed / a.counters.emitted ==
          doctest::Approx(b.counters.absorbed / b.counters.emitted).epsilon(0.005));
}

TEST_CASE("a meter in a plane that lies on a tilted mesh lets no light through it") {
    const glm::dquat tilt = glm::normalize(glm::dquat(0.92, -0.388, 0.058, 0));
    const auto place = [](const glm::dquat& q) { return Place{{0.3, 0.2, 0.1}, {q.x, q.y, q.z, q.w}}; };
    SceneBuilder s;
    add_box(s, {3, 3, 3}, s.lambertian(0.7), true, at(0, 0, 0));
    floor_mesh(1).add_to(s, s.lambertian(0.7), place(tilt));
    watch_last(s);
    // The y of the mesh is the meter's z.
    s.placed("receiver", {{"class", "illuminance"}, {"size", {2, 2}}, {"resolution", {1, 1}}},
             place(tilt * glm::dquat(h, -h, 0, 0)));
    s.light({{"type", "point"}, {"intensity", 100}}, at(0, 1.4, 0));
    Scene scene = compile_test_scene(s.import());
    std::vector<const Receiver*> receivers;
    for (const Receiver& r : scene.receivers) receivers.push_back(&r);
    RenderSettings settings;
    settings.algorithm = Algorithm::forward, settings.forward_paths = 2000;
    MeasurementRun run(test_device(), scene, receivers, settings);
    REQUIRE(run.add({0, 64}, [] { return false; }));
    const Interval on_mesh = figure(parts_of(run.measurement().meters[0])[front_in], "flux"),
                   in_plane = figures_of(run.measurement().meters[1], {})[0].interval;
    CHECK(in_plane.value == doctest::Approx(on_mesh.value).epsilon(5e-4));
}

TEST_CASE(
    "a meter finds its mesh by the name of a node or mesh, or at its node; else it says what is allowed") {
    const auto scene_of = [](const json& receiver, bool on_mesh) {
        SceneBuilder s;
        floor_mesh(1).add_to(s, s.lambertian(0.5));
        s.document["nodes"].back()["name"] = "floor";
        if (on_mesh)
            watch_last(s, receiver);
        else
            s.placed("receiver", receiver, at(0, 1, 0));
        s.light({{"type", "point"}, {"intensity", 1}}, at(0, 2, 0));
        return s.import();
    };
    const auto complaint = [&](const json& receiver, bool on_mesh) {
        try {
            compile_test_scene(scene_of(receiver, on_mesh));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    for (const auto& [receiver, on_mesh] :
         std::vector<std::pair<json, bool>>{{{{"class", "surface"}}, true},
                                            {{{"class", "surface"}, {"mesh", "floor"}}, false},
                                            {{{"class", "surface"}, {"mesh", 0}}, false},
                                            {{{"class", "surface"}, {"node", "floor"}}, false},
                                            {{{"class", "surface"}, {"node", 1}}, false}})
        CHECK(compile_test_scene(scene_of(receiver, on_mesh)).receivers[0].watched.count == 2);
    CHECK(complaint({{"class", "surface"}}, false).find("its node has no mesh") != std::string::npos);
    CHECK(complaint({{"class", "surface"}, {"mesh", "roof"}}, false).find("called roof") !=
          std::string::npos);
    CHECK(complaint({{"class", "surface"}, {"mesh", 3}}, true).find("called /meshes/3") != std::string::npos);
    CHECK(complaint({{"class", "surface"}, {"mesh", true}}, true).find("allowed: the name of a node") !=
          std::string::npos);
    CHECK(complaint({{"class", "surface"}, {"mesh", 0}, {"node", 0}}, true).find("one of the two") !=
          std::string::npos);
}
