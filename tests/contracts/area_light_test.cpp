// Emissive surfaces, on the device, through a compiled scene: what is sampled against what rays hit, and
// illuminance against closed forms.
#include <cmath>
#include <numbers>

#include "host/scene/scene.h"
#include "tests/support/device_fixture.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double false_alarm = 1e-4;

SceneDescription emissive_scene(bool double_sided = false) {
    SceneDescription scene;
    MaterialDescription material;
    material.surface.class_name = "absorber";
    material.emission = EmissionDescription{};
    material.emission->value = {3, 3, 3};
    material.double_sided = double_sided;
    scene.materials.push_back(material);
    return scene;
}

SceneDescription shape_scene(const std::string& name, const nlohmann::json& parameters, const glm::dmat4& m,
                             bool double_sided = false) {
    SceneDescription scene = emissive_scene(double_sided);
    PlacedObject shape;
    shape.object = {name, parameters, "/shape"};
    shape.world_from_local = m;
    scene.shapes.push_back(shape);
    return scene;
}

SceneDescription triangle_scene(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    SceneDescription scene = emissive_scene();
    MeshDescription mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({});
    return scene;
}

// Columns: x, y, z of the frame and its place.
glm::dmat4 placed(glm::dvec3 x, glm::dvec3 y, glm::dvec3 z, glm::dvec3 at) {
    return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(at, 1));
}
glm::dmat4 facing_down(double height) { return placed({1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, height}); }

struct Sample {
    glm::vec3 direction;
    float distance;
    glm::vec3 radiance;
    float pdf;
    float met_pdf, met_radiance;  // of the light where a ray along `direction` hits it; -1 = misses it
};

const char* const sample_text = R"(
    #include "interfaces/light_source.glsl"
    #include "lib/primitives.glsl"
    #include "lib/sampler.glsl"
    layout(local_size_x = 64) in;
    layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };
    struct Sample { vec3 direction; float distance; vec3 radiance; float pdf; float met_pdf; float met_radiance; };
    layout(scalar, set = 0) writeonly buffer Samples { Sample samples[]; };
    layout(scalar, set = 0) readonly buffer Directions { vec3 directions[]; };
    layout(push_constant) uniform Push { uint count, given; float x, y, z; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        vec3 point = vec3(x, y, z);
        uvec3 h = hash_3d(hash_3d(uvec3(i, 3u, 1u)));
        LightSample l = given != 0u ? LightSample(directions[i], 0.0, Spectrum(0), 1.0, 0.0, false)
                                    : light_sample_towards(lights[0], point, vec2(h.xy >> 8) / 16777216.0);
        Sample s = Sample(l.direction, l.distance, l.radiance, l.pdf, -1.0, -1.0);
        if (l.pdf > 0.0) {
            Hit hit = find_hit(point, l.direction, INFINITY);
            if (hit.primitive != NO_RECORD) {
                SurfacePoint p = locate(hit, point, l.direction);
                LightHit at = LightHit(p.position, p.geometric_normal, p.uv0, p.uv1);
                s.met_pdf = light_pdf_towards(lights[p.light], point, l.direction, at);
                s.met_radiance = light_radiance(lights[p.light], l.direction, at).x;
            }
        }
        samples[i] = s;
    }
)";

// Scene coordinates on the device are relative to scene.center.
std::vector<Sample> run_samples(Scene& scene, glm::dvec3 point, uint32_t count,
                                const std::vector<glm::vec3>& directions = {}) {
    scene.sources.generated["sample_area_light.comp"] = sample_text;
    Buffer out(test_device(), uint64_t(count) * sizeof(Sample), "samples");
    Buffer along = create_buffer(test_device(), directions, "directions");
    const Kernel kernel = make_kernel(test_device(), scene, "sample_area_light.comp",
                                      {{"Samples", &out}, {"Directions", &along}});
    const glm::vec3 p(point - scene.center);
    CommandList list(test_device());
    list.dispatch(
        kernel, (count + 63) / 64,
        {{"count", count}, {"given", uint32_t(!directions.empty())}, {"x", p.x}, {"y", p.y}, {"z", p.z}});
    list.run();
    return out.read_array<Sample>(count);
}

Scene compile(const SceneDescription& description) {
    SceneOptions options;
    options.shaders = source_path("shaders");
    return compile_scene(test_device(), description, options);
}

Moments illuminance(const SceneDescription& description, glm::dvec3 point, glm::dvec3 normal) {
    Scene scene = compile(description);
    Moments e;
    for (const Sample& s : run_samples(scene, point, 1 << 19))
        e.add(s.pdf > 0 ? s.radiance.x * std::max(0.0, glm::dot(glm::dvec3(s.direction), normal)) / s.pdf
                        : 0.0);
    return e;
}

void check_illuminance(const SceneDescription& description, glm::dvec3 point, glm::dvec3 normal,
                       double expected) {
    const Moments e = illuminance(description, point, normal);
    CAPTURE(e.mean);
    CAPTURE(expected);
    CHECK(z_test(e.mean, expected, e.standard_error(), 2e-6 * expected) > false_alarm);
}

// Illuminance from a uniform polygon: Lambert's formula, 1/2 L sum of angle * cos of the edge's plane.
double polygon_illuminance(double radiance, std::vector<glm::dvec3> p, glm::dvec3 point, glm::dvec3 normal) {
    double sum = 0;
    for (size_t i = 0; i < p.size(); ++i) {
        const glm::dvec3 a = p[i] - point, b = p[(i + 1) % p.size()] - point, n = glm::cross(a, b);
        sum += std::atan2(glm::length(n), glm::dot(a, b)) * glm::dot(glm::normalize(n), normal);
    }
    return 0.5 * radiance * std::abs(sum);
}

struct Case {
    std::string label;
    SceneDescription scene;
    glm::dvec3 point;
    uint32_t samples = 1 << 17;  // for the chi-squared test
};

std::vector<Case> cases() {
    const glm::dmat4 squeezed = placed({1.5, 0.2, 0}, {0, -0.7, 0.3}, {0.1, 0, -1.2}, {0.1, 0.2, 1.3});
    return {{"triangle", triangle_scene({-1, -1, 1}, {0.5f, 1.5f, 1.5f}, {1.5f, -1, 0.8f}), {0.1, 0.2, 0}},
            {"disk", shape_scene("disk", {{"radius", 1}}, facing_down(0.8)), {0.3, 0.1, 0}},
            {"disk, squeezed", shape_scene("disk", {{"radius", 1}}, squeezed), {0.3, 0.1, 0}},
            {"rectangle", shape_scene("rectangle", {{"size", {2, 1}}}, facing_down(0.6)), {0.3, 0.1, 0}},
            {"sphere", shape_scene("sphere", {{"radius", 0.8}}, facing_down(1.2)), {0.3, 0.1, 0}},
            {"sphere, squeezed", shape_scene("sphere", {{"radius", 0.8}}, squeezed), {0.3, 0.1, -0.2}},
            {"sphere, far", shape_scene("sphere", {{"radius", 0.05}}, facing_down(1)), {0.3, 0.1, 0}},
            {"cylinder",
             shape_scene("cylinder", {{"radius", 0.5}, {"height", 1}}, facing_down(1.3)),
             {0.9, 0.1, 0.2},
             1 << 13}};  // sampled by area, its pdf has a pole along the silhouette, where quadrature is poor
}

}  // namespace

TEST_CASE("area light: sampled directions hit the light with the stated pdf and radiance") {
    for (const Case& c : cases()) {
        CAPTURE(c.label);
        Scene scene = compile(c.scene);
        double misses = 0, lit = 0;
        for (const Sample& s : run_samples(scene, c.point, 1 << 16)) {
            if (!(s.pdf > 0) || s.radiance.x == 0) continue;
            ++lit;
            // At the very edge a ray may pass the light; one that grazes a curved light meets it at another
            // angle.
            if (s.met_radiance != 3.0f || std::abs(s.met_pdf / double(s.pdf) - 1) > 1e-2) ++misses;
        }
        CHECK(lit > 1000);
        CHECK(misses <= 2e-2 * lit);
    }
}

TEST_CASE("area light: directions are sampled with the stated density") {
    constexpr uint32_t rows = 32, columns = 64, fine = 32;
    for (const Case& c : cases()) {
        const uint32_t count = c.samples;
        CAPTURE(c.label);
        Scene scene = compile(c.scene);
        std::vector<glm::vec3> directions;
        for (uint32_t i = 0; i < rows * columns; ++i)
            for (uint32_t j = 0; j < fine * fine; ++j) {
                const double y = 1 - 2 * (i / columns + (j / fine + 0.5) / fine) / rows,
                             s = std::sqrt(1 - y * y);
                const double phi = 2 * pi * (i % columns + (j % fine + 0.5) / fine) / columns;
                directions.push_back(glm::vec3(s * std::cos(phi), s * std::sin(phi), y));
            }
        std::vector<double> observed(rows * columns + 1);
        std::vector<double> expected(rows * columns + 1, 1e-8 * count);  // slivers that quadrature misses
        double dark = 0, total = 0;  // samples of the side that does not emit
        for (const Sample& s : run_samples(scene, c.point, count)) {
            if (!(s.pdf > 0) || s.radiance.x == 0) {
                dark += 1;
                continue;
            }
            double phi = std::atan2(double(s.direction.y), double(s.direction.x));
            if (phi < 0) phi += 2 * pi;
            const auto row = std::min(uint32_t((1 - s.direction.z) / 2 * rows), rows - 1);
            observed[row * columns + std::min(uint32_t(phi / (2 * pi) * columns), columns - 1)] += 1;
        }
        const auto met = run_samples(scene, c.point, uint32_t(directions.size()), directions);
        for (size_t i = 0; i < met.size(); ++i)
            if (met[i].met_radiance > 0) {
                const double p = met[i].met_pdf * (4 * pi / double(met.size()));
                expected[i / (fine * fine)] += p * count;
                total += p;
            }
        observed.back() = dark;
        expected.back() = std::max(0.0, 1 - total) * count;
        if (dark == 0) expected.back() = 0;  // 1 up to quadrature
        // The nearer sphere is sampled over the cone it fills only: nothing is wasted.
        if (c.label == "sphere") CHECK(total == doctest::Approx(1).epsilon(2e-3));
        const ChiSquared chi = chi_squared_test(observed, expected, 20);
        CAPTURE(chi.statistic);
        CAPTURE(chi.degrees);
        CHECK(chi.p_value > sidak_level(false_alarm, cases().size()));
    }
}

TEST_CASE("area light: illuminance from a disk on its axis is pi L r² / (r² + h²)") {
    for (double h : {0.01, 0.5, 20.0})
        check_illuminance(shape_scene("disk", {{"radius", 1.5}}, facing_down(h)), {0, 0, 0}, {0, 0, 1},
                          pi * 3 * 2.25 / (2.25 + h * h));
}

TEST_CASE("area light: illuminance from a sphere is pi L r² / d², near and far") {
    for (double d : {1.01, 3.0, 1000.0})
        check_illuminance(shape_scene("sphere", {{"radius", 1}}, facing_down(d)), {0, 0, 0}, {0, 0, 1},
                          pi * 3 / (d * d));
}

TEST_CASE("area light: inside an emissive sphere seen from within there is none, double-sided pi L") {
    check_illuminance(shape_scene("sphere", {{"radius", 1}}, facing_down(0)), {0.3, 0, 0}, {0, 0, 1}, 0);
    check_illuminance(shape_scene("sphere", {{"radius", 1}}, facing_down(0), true), {0.3, 0, 0}, {0, 0, 1},
                      3 * pi);
}

TEST_CASE("area light: illuminance from a rectangle and a triangle is Lambert's") {
    const glm::dvec3 point(0.3, 0.1, 0), normal = glm::normalize(glm::dvec3(0.1, 0.2, 1));
    for (double h : {0.6, 6.0})
        check_illuminance(
            shape_scene("rectangle", {{"size", {2, 1}}}, facing_down(h)), point, normal,
            polygon_illuminance(3, {{-1, -0.5, h}, {1, -0.5, h}, {1, 0.5, h}, {-1, 0.5, h}}, point, normal));
    const glm::vec3 a(-1, -1, 1), b(0.5f, 1.5f, 1.5f), c(1.5f, -1, 0.8f);
    check_illuminance(triangle_scene(a, b, c), point, normal,
                      polygon_illuminance(3, {a, b, c}, point, normal));
}

TEST_CASE("area light: a surface emits on the side of its normal only, unless double-sided") {
    const glm::dmat4 up = placed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1});
    check_illuminance(shape_scene("disk", {{"radius", 1}}, up), {0, 0, 0}, {0, 0, 1}, 0);
    check_illuminance(shape_scene("disk", {{"radius", 1}}, up, true), {0, 0, 0}, {0, 0, 1}, pi * 3 / 2);
}

TEST_CASE("area light: the power of a surface is pi L times its area, on each side that emits") {
    CHECK(compile(shape_scene("disk", {{"radius", 2}}, facing_down(1))).power ==
          doctest::Approx(pi * 3 * pi * 4).epsilon(1e-5));
    CHECK(compile(shape_scene("disk", {{"radius", 2}}, facing_down(1), true)).power ==
          doctest::Approx(2 * pi * 3 * pi * 4).epsilon(1e-5));
    CHECK(compile(triangle_scene({0, 0, 0}, {2, 0, 0}, {0, 1, 0})).power ==
          doctest::Approx(pi * 3).epsilon(1e-5));
}
