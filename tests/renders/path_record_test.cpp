// Recorded paths: against Snell's law, absorption, the layers of an image and what the renderer counts.
#include "host/render/path_record.h"

#include <cmath>
#include <numeric>

#include "host/error.h"
#include "host/gpu/shader_compiler.h"
#include "host/gltf/gltf.h"
#include "host/scene/spectral_value.h"
#include "tests/support/render_probe.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

RenderSettings settings_for(const Scene& scene, uint32_t width, uint32_t height) {
    RenderSettings settings;
    settings.width = width, settings.height = height;
    settings.receiver = scene.receivers.at(0).ref;
    settings.seed = 3;
    return settings;
}

std::vector<RecordedPath> record_all(Scene& scene, const RenderSettings& settings, bool forward,
                                     uint64_t passes = 1) {
    PathRecorder recorder(test_device(), scene, settings, forward, 1024);
    std::vector<uint32_t> all(recorder.paths_a_pass());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<RecordedPath> paths;
    for (uint64_t pass = 0; pass < passes; ++pass)
        for (RecordedPath& path : recorder.record(pass, all)) paths.push_back(std::move(path));
    return paths;
}

glm::dvec3 direction(const RecordedPath& path, size_t to) {
    return glm::normalize(path.vertices.at(to).position - path.vertices.at(to - 1).position);
}

// How far the directions before and behind a vertex are from those of the law of refraction or of reflection.
double snell_error(const glm::dvec3& in, const glm::dvec3& out, glm::dvec3 n, bool refracted, double ior) {
    if (!refracted) return glm::length(glm::reflect(in, n) - out);
    const double eta = glm::dot(in, n) < 0 ? 1 / ior : ior;
    if (glm::dot(in, n) > 0) n = -n;
    return glm::length(glm::refract(in, n, eta) - out);
}

constexpr double radius = 0.5, ior = 1.5, sigma = 0.8;

// A ball of grey glass on a white floor, in front of a lamp and a camera.
SceneBuilder ball_and_lamp() {
    SceneBuilder s;
    s.medium("glass", {{"ior", ior}, {"absorption", sigma}});
    const int floor = s.lambertian(0.5), lamp = s.black_emitter(100);
    s.rectangle(3, 3, floor, at(0, 0, -0.8));
    s.document["materials"][0]["name"] = "floor", s.document["materials"][1]["name"] = "lamp";
    s.sphere(0.2, lamp, at(0.4, 0, 1.5));
    const int ball =
        s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}, {{"name", "ball"}});
    s.sphere(radius, ball, at(0, 0, 0));
    s.perspective(0.8, at(0, 0, 3));
    return s;
}

}  // namespace

TEST_CASE("what the prism of the example refracts obeys Snell's law at the wavelength that is left") {
    const SceneDescription description = import_gltf(source_path("scenes/prism.gltf"));
    Scene scene = compile_test_scene(description);
    const SpectralTable glass =
        *spectral_value({{"name", "SF11 ior"}}, description, "", SpectralKind::index).table;
    const MeshDescription& prism = description.meshes.at(0);
    // The normal of the face that a point lies on.
    const auto normal_at = [&](const glm::dvec3& p) {
        double nearest = INFINITY;
        glm::dvec3 normal(0);
        for (const glm::uvec3& t : prism.triangles) {
            const glm::dvec3 a = prism.positions[t.x], b = prism.positions[t.y], c = prism.positions[t.z];
            const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
            if (const double off = std::abs(glm::dot(p - a, n)); off < nearest) nearest = off, normal = n;
        }
        CHECK(nearest < 1e-6);
        return normal;
    };
    double least_nm = 1e3, most_nm = 0, worst = 0;
    size_t found = 0, of_beam = 0;
    for (const RecordedPath& path : record_all(scene, settings_for(scene, 40, 4), true, 8)) {
        of_beam += path.vertices[0].object == "beam";
        for (size_t i = 1; i + 1 < path.vertices.size(); ++i) {
            const PathVertex& v = path.vertices[i];
            if (v.object != "flint glass" || v.event == PathEvent::absorbed || v.roulette) continue;
            CHECK(v.smooth);
            const double nm = wavelength_at(path, v);
            REQUIRE(nm > 0);
            least_nm = std::min(least_nm, nm), most_nm = std::max(most_nm, nm);
            // Points are rounded to 1e-7 m or so: that turns short segments, and bends grazing ones by more.
            const glm::dvec3 n = normal_at(v.position), out = direction(path, i + 1);
            const double segment = std::min(glm::length(v.position - path.vertices[i - 1].position),
                                            glm::length(v.position - path.vertices[i + 1].position));
            const double error =
                snell_error(direction(path, i), out, n, v.event == PathEvent::refracted, glass.at(nm));
            worst = std::max(worst, error * segment * std::abs(glm::dot(out, n)));
            ++found;
        }
    }
    CHECK(of_beam > 100);
    CHECK(found > 1000);
    CHECK(worst < 1e-6);
    CHECK(most_nm - least_nm > 100);
}

TEST_CASE("events in a ball of glass, and what it absorbs") {
    Scene scene = compile_test_scene(ball_and_lamp().import());
    std::map<PathEvent, size_t> at_ball;
    double worst_angle = 0, worst_passage = 0, worst_floor = 0, power = 0;
    const auto paths = record_all(scene, settings_for(scene, 64, 64), true);
    for (const RecordedPath& path : paths) {
        const auto& v = path.vertices;
        CHECK(v[0].event == PathEvent::emitted);
        CHECK(v[0].object == "lamp");
        power += v[0].leaving;
        bool inside = false;
        for (size_t i = 1; i < v.size(); ++i) {
            CAPTURE(i);
            CHECK_FALSE(path.is_cut);
            const double length = glm::length(v[i].position - v[i - 1].position);
            if (v[i].event != PathEvent::escaped)
                worst_passage = std::max(worst_passage, std::abs(v[i].arriving / v[i - 1].leaving -
                                                                 (inside ? std::exp(-sigma * length) : 1.0)));
            const bool last = i + 1 == v.size();
            if (v[i].object == "floor" && i < 3)
                worst_floor = std::max(worst_floor, std::abs(v[i].leaving / v[i].arriving - 0.5));
            if (v[i].object == "lamp") CHECK(v[i].event == PathEvent::absorbed);
            if (v[i].event == PathEvent::escaped || v[i].event == PathEvent::absorbed) CHECK(last);
            if (v[i].object != "ball" || last) continue;
            CHECK(std::abs(glm::length(v[i].position) - radius) < 1e-6);
            const bool refracted = v[i].event == PathEvent::refracted;
            CHECK((refracted || v[i].event == PathEvent::reflected));
            worst_angle = std::max(worst_angle, snell_error(direction(path, i), direction(path, i + 1),
                                                            glm::normalize(v[i].position), refracted, ior));
            at_ball[v[i].event]++;
            if (refracted) inside = !inside;
        }
    }
    CHECK(power == doctest::Approx(scene.power).epsilon(1e-4));
    CHECK(at_ball[PathEvent::refracted] > 100);
    CHECK(at_ball[PathEvent::reflected] > 10);
    CHECK(worst_angle < 1e-4);
    CHECK(worst_passage < 1e-5);
    CHECK(worst_floor < 1e-6);
    PathFilter filter{{PathEvent::refracted}, {"ball"}};
    const auto through = std::count_if(paths.begin(), paths.end(), [&](auto& p) { return filter.keeps(p); });
    filter = {{PathEvent::refracted}, {"floor"}};
    CHECK(std::none_of(paths.begin(), paths.end(), [&](auto& p) { return filter.keeps(p); }));
    CHECK(through > 20);
    CHECK(through < 2000);
    filter = {{}, {}, {"ball"}};
    const auto past = std::count_if(paths.begin(), paths.end(), [&](auto& p) { return filter.keeps(p); });
    const auto touching = std::count_if(paths.begin(), paths.end(), [&](auto& p) {
        return std::any_of(p.vertices.begin(), p.vertices.end(), [](auto& v) { return v.object == "ball"; });
    });
    CHECK(touching > 20);
    CHECK(past + touching == std::ptrdiff_t(paths.size()));
}

namespace {

// Plates side by side of one material: a mesh, another one placed twice, of so many squares along a side, and
// an analytic shape, seen from the front.
SceneBuilder four_plates(uint32_t squares) {
    SceneBuilder s;
    const int white = s.lambertian(0.5);
    const auto grid = [&](uint32_t n, const Place& place) {
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        for (uint32_t y = 0; y <= n; ++y)
            for (uint32_t x = 0; x <= n; ++x) {
                positions.push_back(
                    {0.8f * float(x) / float(n) - 0.4f, 0.8f * float(y) / float(n) - 0.4f, 0});
                const uint32_t i = y * (n + 1) + x, above = i + n + 1;
                if (x < n && y < n) indices.insert(indices.end(), {i, i + 1, above + 1, i, above + 1, above});
            }
        s.mesh(positions, indices, white, place);
    };
    const auto name = [&](const char* text) { s.document["nodes"].back()["name"] = text; };
    grid(1, at(-1.5, 0, 0)), name("first");
    grid(squares, at(-0.5, 0, 0)), name("second");
    s.mesh_copy(at(0.5, 0, 0)), name("third");
    s.rectangle(0.8, 0.8, white, at(1.5, 0, 0)), name("fourth");
    s.environment(1);
    s.perspective(0.9, at(0, 0, 4), "eye");
    return s;
}

}  // namespace

TEST_CASE("paths know the shapes and nodes that they come to") {
    for (const uint32_t squares : {1u, 200u}) {  // all merged, or true instances
        CAPTURE(squares);
        Scene scene = compile_test_scene(four_plates(squares).import());
        CHECK(scene.features.instances == (squares > 1));
        std::map<std::string, int> met;
        const auto paths = record_all(scene, settings_for(scene, 64, 24), false);
        for (const RecordedPath& path : paths) {
            const PathVertex& v = path.vertices.at(1);
            if (v.event == PathEvent::escaped) {
                CHECK(v.shape == "");
                continue;
            }
            const char* names[] = {"first", "second", "third", "fourth"};
            CHECK(v.shape == names[int(std::floor(v.position.x)) + 2]);
            ++met[v.shape];
        }
        CHECK(met.size() == 4);
        const PathFilter third{{}, {"third"}, {}}, others{{}, {}, {"third"}};
        CHECK(std::count_if(paths.begin(), paths.end(), [&](auto& p) { return third.keeps(p); }) ==
              met["third"]);
        CHECK(std::count_if(paths.begin(), paths.end(), [&](auto& p) { return others.keeps(p); }) ==
              std::ptrdiff_t(paths.size()) - met["third"]);
    }
}

TEST_CASE("paths are those that the renderer traces") {
    Scene scene = compile_test_scene(ball_and_lamp().import());
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward}) {
        const bool forward = algorithm == Algorithm::forward;
        CAPTURE(forward);
        RenderSettings settings = settings_for(scene, 24, 16);
        settings.algorithm = algorithm;
        Renderer renderer(test_device(), scene, settings);
        renderer.render_passes(3);
        uint64_t rays = 0;
        double escaped = 0;
        for (const RecordedPath& path : record_all(scene, settings, forward, 3)) {
            rays += path.vertices.size() - 1;
            const PathVertex& last = path.vertices.back();
            if (last.event != PathEvent::escaped) continue;
            if (forward)
                escaped += last.leaving / (scene.power / (24 * 16));
            else
                escaped += double(last.throughput.x + last.throughput.y + last.throughput.z) / 3;
        }
        const RenderCounters& c = renderer.counters();
        CHECK(rays == (forward ? c.forward_rays : c.rays));
        CHECK(escaped == doctest::Approx(forward ? c.forward_escaped : c.escaped).epsilon(1e-5));
    }
}

TEST_CASE("recorded paths tell how what they carry is polarized") {
    SceneBuilder s;
    s.orthographic(1, at(0, 0, 3));
    s.placed("light", {{"class", "spot"}, {"outer_cone_angle", 0.2}, {"stokes", {1, 0.6, 0, -0.3}}},
             at(0, 0, 2));
    const double turn = 0.4;
    s.rectangle(2, 2, s.surface({{"class", "linear_polarizer"}, {"axis", turn}}), at(0, 0, 1));
    s.rectangle(2, 2, s.lambertian(0.5), at(0, 0, 0));
    Scene scene = compile_test_scene(s.import());
    const RenderSettings settings = settings_for(scene, 8, 8);
    size_t met = 0;
    for (const RecordedPath& path : record_all(scene, settings, true)) {
        const auto& v = path.vertices;
        REQUIRE(v.size() >= 2);
        REQUIRE(v[0].polarization);
        CHECK(glm::length(v[0].polarization->stokes) ==
              doctest::Approx(std::sqrt(0.36 + 0.09)).epsilon(1e-4));
        CHECK(v[0].polarization->stokes.z == doctest::Approx(-0.3).epsilon(1e-4));
        if (v[1].event != PathEvent::straight || !v[1].polarization) continue;
        // Linear along the sheet's axis, as the light sees it.
        const glm::dvec3 d = glm::normalize(v[1].position - v[0].position), x = v[1].polarization->axis;
        const glm::dvec3 sheet(std::cos(turn), std::sin(turn), 0), across = glm::cross(d, x);
        const double angle = std::atan2(glm::dot(sheet, across), glm::dot(sheet, x));
        CHECK(v[1].polarization->stokes.x == doctest::Approx(std::cos(2 * angle)).epsilon(0.02));
        CHECK(v[1].polarization->stokes.y == doctest::Approx(std::sin(2 * angle)).epsilon(0.02));
        CHECK(std::fabs(glm::length(v[1].polarization->stokes) - 1) < 1e-4);
        ++met;
    }
    CHECK(met > 20);
}

TEST_CASE("a pixel's path meets first what the layers of the image say") {
    SceneBuilder s = ball_and_lamp();
    Scene scene = compile_test_scene(s.import());
    const RenderSettings settings = settings_for(scene, 24, 16);
    Renderer renderer(test_device(), scene, settings);
    Image image = renderer.develop(false);
    renderer.add_aovs(image, 1);
    const auto depth = plane(image, size_t(find_channel(image, "depth.Z")));
    PathRecorder recorder(test_device(), scene, settings, false);
    size_t met = 0;
    for (const RecordedPath& path : record_all(scene, settings, false)) {
        CHECK(glm::length(path.vertices[0].position - glm::dvec3(0, 0, 3)) < 1e-6);
        const PathVertex& first = path.vertices.at(1);
        const double distance = glm::length(first.position - path.vertices[0].position);
        if (first.event == PathEvent::escaped) {
            CHECK(depth[path.index] == 0);
            continue;
        }
        CHECK(distance == doctest::Approx(double(depth[path.index])).epsilon(1e-5));
        ++met;
    }
    CHECK(met > 100);
    CHECK_THROWS_AS(recorder.record(0, std::vector<uint32_t>{24 * 16}), Error);
}

TEST_CASE("light scatters within a medium, and lines have the colours of wavelengths") {
    SceneBuilder s = ball_and_lamp();
    s.optics()["media"][0]["scattering"] = 5;
    Scene scene = compile_test_scene(s.import());
    size_t scattered = 0;
    for (const RecordedPath& path : record_all(scene, settings_for(scene, 16, 16), false))
        for (const PathVertex& v : path.vertices)
            if (v.event == PathEvent::scattered) {
                CHECK(v.object == "glass");
                CHECK(glm::length(v.position) < radius + 1e-5);
                ++scattered;
            }
    CHECK(scattered > 50);

    RecordedPath path;
    PathVertex vertex;
    path.wavelengths = {450, 500, 550, 600};
    vertex.throughput = {0.5, 0, 0, 0};
    CHECK(wavelength_at(path, vertex) == 450);
    const glm::vec3 blue = line_color(path, vertex);
    CHECK(blue.z == 1);
    CHECK(blue.y < 0.2);
    path.wavelengths.x = 640;
    CHECK(line_color(path, vertex).x == 1);
    vertex.throughput.y = 0.1, vertex.color = {2, 4, 1};
    CHECK(line_color(path, vertex) == glm::vec3(0.5, 1, 0.25));
}
