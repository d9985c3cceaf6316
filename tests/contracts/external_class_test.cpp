// The property of the architecture: a class from outside the source tree is one file, named by the scene.
// Nothing of the program knows the two classes written here.
#include <doctest/doctest.h>

#include <cmath>

#include "host/error.h"
#include "host/gltf/gltf.h"
#include "tests/support/render_probe.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

// A lobe around the normal, cos^exponent, that reflects the same part of the light in every direction of
// view.
const char* velvet = R"(// A soft lobe around the normal.
struct Velvet {
    SpectrumRef tint;   //: 0.5 in [0, 1]. Reflected part of what comes from everywhere.
    float exponent;     //: required in [0, 100]. Of the cosine.
};

Velvet velvet_resolve(Velvet r, SurfaceContext c) { return r; }
float velvet_pdf(Velvet r, float cosine) {
    return (r.exponent + 1.0) * 0.5 * INV_PI * pow(abs(cosine), r.exponent);
}
SurfacePair velvet_evaluate(Velvet r, SurfaceContext c, vec3 wo, vec3 wi) {
    if (!(wo.z * wi.z > 0.0)) return no_surface_pair();
    float pdf = velvet_pdf(r, wi.z);
    return SurfacePair(spectrum_value(r.tint) * pdf, pdf, velvet_pdf(r, wo.z));
}
BsdfSample velvet_sample(Velvet r, SurfaceContext c, vec3 wo, vec3 u) {
    float z = pow(1.0 - u.x, 1.0 / (r.exponent + 1.0));
    float s = sqrt(max(0.0, 1.0 - z * z)), phi = 6.2831853 * u.y;
    return scattered(vec3(s * cos(phi), s * sin(phi), wo.z < 0.0 ? -z : z), EVENT_REFLECT);
}
Spectrum velvet_transparency(Velvet r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool velvet_is_delta(Velvet r, SurfaceContext c) { return false; }
bool velvet_is_opaque(Velvet r, SurfaceContext c) { return true; }
)";

// z = height (x² + y²) / radius², from the apex at the origin up to the rim; the normal points outward
// (downward).
const char* paraboloid = R"(// A bowl.
#include "lib/warps.glsl"

struct Paraboloid {
    float radius;  //: required in (0, inf) m. Of the rim.
    float height;  //: 1 in (0, inf) m. Of the rim above the apex.
};

bool paraboloid_intersect(Paraboloid r, vec3 o, vec3 d, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(0));
    float k = r.height / (r.radius * r.radius);
    float a = k * dot(d.xy, d.xy), b = k * dot(o.xy, d.xy) - 0.5 * d.z, c = k * dot(o.xy, o.xy) - o.z;
    float discriminant = b * b - a * c;
    if (!(discriminant >= 0.0)) return false;
    float q = -b - (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant);
    float t0 = a != 0.0 ? q / a : INFINITY, t1 = q != 0.0 ? c / q : INFINITY;
    float near = min(t0, t1), far = max(t0, t1);
    bool near_met = near > 0.0 && near < t_max && o.z + near * d.z <= r.height;
    bool far_met = far > 0.0 && far < t_max && o.z + far * d.z <= r.height;
    hit.t = near_met ? near : far;
    return near_met || far_met;
}

LocalPoint paraboloid_locate(Paraboloid r, vec3 o, vec3 d, GeometryHit hit) {
    vec3 p = o + hit.t * d;
    float k = r.height / (r.radius * r.radius);
    p.z = k * dot(p.xy, p.xy);
    return LocalPoint(p, vec3(0.0, 0.0, 8.0 * EPSILON * r.height), normalize(vec3(2.0 * k * p.xy, -1.0)),
                      vec3(1.0, 0.0, 2.0 * k * p.x), p.xy / r.radius);
}

float paraboloid_area(Paraboloid r) {
    float s = 1.0 + 4.0 * r.height * r.height / (r.radius * r.radius);
    return PI * pow(r.radius, 4.0) / (6.0 * r.height * r.height) * (s * sqrt(s) - 1.0);
}

GeometrySample paraboloid_sample(Paraboloid r, vec2 u) {
    // By area: the radius whose bowl below it has the part u.x of the area.
    float k = 2.0 * r.height / (r.radius * r.radius);
    float s = pow(1.0 + u.x * (pow(1.0 + k * k * r.radius * r.radius, 1.5) - 1.0), 2.0 / 3.0);
    float rho = sqrt(max(0.0, s - 1.0)) / k, phi = 6.2831853 * u.y;
    vec3 p = vec3(rho * cos(phi), rho * sin(phi), 0.0);
    p.z = 0.5 * k * dot(p.xy, p.xy);
    return GeometrySample(p, normalize(vec3(k * p.xy, -1.0)), 1.0 / paraboloid_area(r));
}
GeometrySample paraboloid_sample_towards(Paraboloid r, vec3 reference, vec2 u) { return paraboloid_sample(r, u); }
float paraboloid_pdf_towards(Paraboloid r, vec3 reference, vec3 position, vec3 normal) { return 1.0 / paraboloid_area(r); }
void paraboloid_bounds(Paraboloid r, out vec3 lo, out vec3 hi) {
    lo = vec3(-r.radius, -r.radius, 0.0), hi = vec3(r.radius, r.radius, r.height);
}
)";

// Two cells of 4 m: a velvet sphere, and the bowl in black from the side, far behind so that the sphere does
// not see it.
struct Visitors {
    TemporaryFolder folder;
    SceneBuilder scene;
    explicit Visitors(json velvet_parameters = {{"tint", {0.8, 0.4, 0.2}}, {"exponent", 3}},
                      json bowl_parameters = {{"radius", 1.25}, {"height", 2}}) {
        write_text(folder / "velvet.glsl", velvet);
        write_text(folder / "paraboloid.glsl", paraboloid);
        scene.optics()["class_files"] = {{{"interface", "surface"}, {"file", "velvet.glsl"}},
                                         {{"interface", "geometry"}, {"file", "paraboloid.glsl"}}};
        velvet_parameters["class"] = "velvet";
        bowl_parameters["class"] = "paraboloid";
        scene.sphere(1.5, scene.surface(velvet_parameters), at(2, 0, 0));
        // On its side: the axis along +y.
        const json up = {-0.70710678118654752, 0, 0, 0.70710678118654752};
        scene.shape(bowl_parameters, scene.surface({{"class", "absorber"}}), Place{{6, -1, -100}, up});
        scene.orthographic(2, at(4, 0, 10));
        scene.environment(1);
    }
    SceneDescription import() const { return scene.import(folder / "scene.gltf"); }
    std::string complaint() const {
        try {
            compile_test_scene(import());
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            CHECK(std::string(e.what()).find('\n') == std::string::npos);
            return e.what();
        }
        return "no error";
    }
};

}  // namespace

TEST_CASE("a scene brings its own surface and its own geometry, one file each") {
    const Visitors visitors;
    RenderPlan plan;
    plan.width = 64, plan.height = 32, plan.passes = 64, plan.seeds = 4;
    const Estimates e = render_estimates(visitors.import(), plan);
    // Convex and alone under a constant environment, the sphere reflects its tint of it.
    const Window middle = {9, 9, 14, 14};
    const double tint[3] = {0.8, 0.4, 0.2};
    for (int c = 0; c < 3; ++c) {
        const WindowMean m = window_mean(e, middle, c);
        CAPTURE(m.standard_error);
        CHECK(m.mean == doctest::Approx(tint[c]).epsilon(0.01));
    }
    // The black bowl hides its silhouette, 4/3 radius height, of the 16 m² of its cell.
    CHECK(window_mean(e, {32, 0, 32, 32}).mean ==
          doctest::Approx(1 - 4.0 / 3 * 1.25 * 2 / 16).epsilon(0.002));
}

TEST_CASE("parameters of a brought class are checked by its file") {
    SUBCASE("an unknown one is named") {
        const std::string line = Visitors(json::object({{"exponent", 2}, {"softness", 1}})).complaint();
        CHECK_MESSAGE(line.find("softness") != std::string::npos, line);
        CHECK_MESSAGE(line.find("exponent") != std::string::npos, line);  // what is allowed
    }
    SUBCASE("a value out of range") {
        const std::string line = Visitors(json::object({{"exponent", -1}})).complaint();
        CHECK_MESSAGE(line.find("exponent") != std::string::npos, line);
        CHECK_MESSAGE(line.find("[0, 100]") != std::string::npos, line);
    }
    SUBCASE("a required one that is missing") {
        const std::string line =
            Visitors(json::object({{"exponent", 2}}), json::object({{"height", 1}})).complaint();
        CHECK_MESSAGE(line.find("radius") != std::string::npos, line);
    }
}

TEST_CASE("a class file that is missing or does not compile is one line that names it") {
    Visitors visitors;
    SUBCASE("missing") { std::filesystem::remove(visitors.folder / "velvet.glsl"); }
    SUBCASE("without its record") {
        write_text(visitors.folder / "velvet.glsl", "struct Other { float a; };\n");
    }
    SUBCASE("not GLSL") {
        write_text(visitors.folder / "velvet.glsl", "struct Velvet { float exponent; };\nfloat x = ;\n");
    }
    const std::string line = visitors.complaint();
    CHECK_MESSAGE(line.find("velvet.glsl") != std::string::npos, line);
}
