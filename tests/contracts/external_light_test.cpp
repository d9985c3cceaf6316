// Lights from outside the source tree, one file each: a bright line that no ray can meet, though it is no
// point, and a sky that is brightest in the zenith. Nothing of the program knows them, and all algorithms
// render them.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renders/algorithm_comparison.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

// Densities have the line's 1/m in place of the surface's 1/m².
const char* line = R"(// A line along x of its node that shines alike in all directions.
struct Line {
    Placement placement;
    SpectrumRef color;   //: 1 in [0, inf). Multiplies the intensity.
    float intensity;     //: required in [0, inf) cd/m. Luminous intensity of a metre.
    float size;          //: 1 in (0, inf) m. Length.
};

vec3 line_point(Line r, float x) {
    return r.placement.world_from_local[3] + r.size * (x - 0.5) * normalize(r.placement.world_from_local[0]);
}
float line_emission_pdf(Line r) { return 0.25 * INV_PI / r.size; }

LightSample line_sample_towards(Line r, vec3 point, vec2 u) {
    vec3 d = line_point(r, u.x) - point;
    float distance = length(d);
    if (!(distance > 0.0)) return no_light_sample();
    return LightSample(d / distance, distance, spectrum_value(r.color) * r.intensity, square(distance) / r.size,
                       line_emission_pdf(r), true);
}
float line_pdf_towards(Line r, vec3 point, vec3 direction, LightHit hit) {
    vec3 d = hit.position - point;
    return dot(d, d) / r.size;
}
Spectrum line_radiance(Line r, vec3 direction, LightHit hit) { return Spectrum(0); }

EmittedRay line_emit(Line r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    float z = 1.0 - 2.0 * u_direction.x;
    vec3 direction = vec3(cos_sin_turns(u_direction.y) * sqrt(max(0.0, 1.0 - z * z)), z);
    return EmittedRay(line_point(r, u_position.x), vec3(0), direction, direction, spectrum_value(r.color) * r.intensity,
                      line_emission_pdf(r), true, true);
}
float line_pdf_emit(Line r, SceneBounds bounds, vec3 direction, LightHit hit) { return line_emission_pdf(r); }

float line_power(Line r, SceneBounds bounds) {
    return 4.0 * PI * r.intensity * r.size * luminance(spectrum_value(r.color));
}
void line_bounds(Line r, out vec3 lo, out vec3 hi) {
    vec3 a = line_point(r, 0.0), b = line_point(r, 1.0);
    lo = min(a, b), hi = max(a, b);
}
LightCone line_cone(Line r) { return whole_sphere_cone(); }
)";

const char* dome = R"(// A sky whose radiance falls from the zenith, +z, to nothing at the horizon.
struct Dome {
    SpectrumRef zenith;  //: 1 in [0, inf) cd/m². Radiance there.
};

float dome_density(vec3 direction) { return INV_PI * max(0.0, direction.z); }

LightSample dome_sample_towards(Dome r, vec3 point, vec2 u) {
    vec3 direction = warp_cosine_hemisphere(u);
    return LightSample(direction, INFINITY, spectrum_value(r.zenith) * direction.z, dome_density(direction),
                       dome_density(direction) * outer_disk_pdf(scene_bounds()), false);
}
float dome_pdf_towards(Dome r, vec3 point, vec3 direction, LightHit hit) { return dome_density(direction); }
Spectrum dome_radiance(Dome r, vec3 direction, LightHit hit) { return spectrum_value(r.zenith) * max(0.0, direction.z); }

EmittedRay dome_emit(Dome r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    vec3 direction = -warp_cosine_hemisphere(u_direction);
    return EmittedRay(outer_disk_point(bounds, direction, u_position), vec3(0), direction, direction,
                      spectrum_value(r.zenith) * -direction.z, dome_density(-direction) * outer_disk_pdf(bounds), false,
                      true);
}
float dome_pdf_emit(Dome r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return dome_density(direction) * outer_disk_pdf(bounds);
}

float dome_power(Dome r, SceneBounds bounds) { return square(PI * bounds.radius) * luminance(spectrum_value(r.zenith)); }
void dome_bounds(Dome r, out vec3 lo, out vec3 hi) { lo = vec3(1), hi = vec3(-1); }
LightCone dome_cone(Dome r) { return whole_sphere_cone(); }
)";

constexpr double intensity = 2, length = 1.5, height = 1.2, zenith = 0.6, reflectance = 0.5;

void add_line(SceneBuilder& s, const Place& place) {
    s.placed("light", {{"class", "line"}, {"intensity", intensity}, {"size", length}}, place);
}

// Of a floor that sees nothing but a line above its middle and the sky.
double floor_radiance(double x, double y) {
    const double a = y * y + height * height;
    const auto antiderivative = [&](double t) { return (t - x) / std::hypot(t - x, std::sqrt(a)); };
    const double of_line =
        intensity * height / a * (antiderivative(length / 2) - antiderivative(-length / 2));
    const double of_sky = zenith * 2 * std::numbers::pi / 3;  // integral of cos² over the hemisphere
    return reflectance / std::numbers::pi * (of_line + of_sky);
}

}  // namespace

TEST_CASE("a scene brings its own lights, one file each, and all algorithms render them") {
    const TemporaryFolder folder;
    write_text(folder / "line.glsl", line);
    write_text(folder / "dome.glsl", dome);
    SceneBuilder s;
    s.optics()["class_files"] = {{{"interface", "light"}, {"file", "line.glsl"}},
                                 {{"interface", "light"}, {"file", "dome.glsl"}}};
    s.optics()["environment"] = {{"class", "dome"}, {"zenith", zenith}};
    // Below, a floor and a metal sphere; above, a floor that nothing else sends light to.
    const int white = s.lambertian(reflectance);
    s.rectangle(2, 2, white, at(0, 0, 0));
    s.sphere(0.4, s.surface({{"class", "conductor"}, {"alpha", 0.3}, {"reflectance", {0.9, 0.8, 0.6}}}),
             at(0.2, 0.1, 0.3));
    add_line(s, {{0, 0, 2}, {0, 0.258819045, 0, 0.965925826}});
    s.orthographic(1, at(0, 0, 1.5), "below");
    constexpr double upper = 4, view = 0.8;  // m
    s.rectangle(3, 3, white, at(0, 0, upper));
    add_line(s, at(0, 0, upper + height));
    s.orthographic(view, at(0, 0, upper + 0.5), "above");
    Scene scene = compile_test_scene(s.import(folder / "scene.gltf"));

    Comparison comparison;
    comparison.width = comparison.height = 24;
    comparison.forward = 512;  // most rays of the sky miss the floors
    check_against_backward(scene, comparison);

    RenderPlan plan;
    plan.width = plan.height = 16, plan.seeds = 8;
    plan.receiver = "above";
    std::vector<double> expected;
    for (uint32_t y = 0; y < plan.height; ++y)
        for (uint32_t x = 0; x < plan.width; ++x)
            expected.insert(expected.end(), 3,
                            floor_radiance(view * ((x + 0.5) / 8 - 1), view * (1 - (y + 0.5) / 8)));
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        const std::string name = algorithm_name(algorithm);
        CAPTURE(name);
        plan.algorithm = algorithm, plan.passes = algorithm == Algorithm::forward ? 1024 : 128;
        const Estimates e = render_estimates(scene, plan);
        const WindowMean mean = window_mean(e);
        const double wanted = window_mean(expected, plan.width, {});
        MESSAGE(name, ": ", mean.mean, " +- ", mean.standard_error, ", expected ", wanted);
        CHECK(std::fabs(mean.mean - wanted) < 0.0005 * wanted + 4 * mean.standard_error);
        CHECK(mean.standard_error < 0.004 * wanted);
        CHECK(agreement(e, expected, 4).holds);
    }
}
