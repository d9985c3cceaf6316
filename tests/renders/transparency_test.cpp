// Light through things: absorbing slabs, panes, alpha, against closed forms, both seen directly and by shadow
// rays.
//
// Seen directly: an emitter lies under the thing and the camera looks down through it. By shadow rays: a
// point light hangs above the thing and the camera, under it, sees the floor.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renders/cell_row.h"

using namespace etendue;

namespace {

constexpr double absorption = 0.7, thickness = 0.5, ior = 1.5;  // 1/m, m

nlohmann::json inside(const char* surface, const char* medium) {
    return {{"surface", {{"class", surface}}}, {"inside", medium}};
}

// A slab whose lower face is at z, larger than its cell: of two rectangles with the medium between them.
void add_slab(SceneBuilder& s, const char* surface, const char* medium, double x, double z) {
    const int material = s.material(inside(surface, medium));
    s.rectangle(1.99, 4, material, at(x, 0, z + thickness));
    s.rectangle(1.99, 4, material, facing_down(x, 0, z));
}

void add_emitter(SceneBuilder& s, double x) { s.rectangle(1.99, 4, s.black_emitter(1), at(x, 0, -2)); }

// The emitter is a little narrower than its cell: the outermost pixels see its rim.
double emitter_seen(double x) { return std::fabs(x) > 0.9 ? 0.96 : 1.0; }

int alpha_material(SceneBuilder& s, double alpha) {
    // Black where it is not transparent, but for its reflection, which has nothing to reflect.
    return s.material(
        nlohmann::json::object(),
        {{"alphaMode", "BLEND"},
         {"doubleSided", true},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, alpha}}, {"roughnessFactor", 1}}}});
}

glm::dvec2 fresnel_parts(double cosine) {  // of s and p
    const double t = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
    const double s = (cosine - ior * t) / (cosine + ior * t), p = (ior * cosine - t) / (ior * cosine + t);
    return {s * s, p * p};
}
double fresnel(double cosine) { return 0.5 * (fresnel_parts(cosine).x + fresnel_parts(cosine).y); }
// s and p meet the second face as they have left the first.
double pane_transmittance(double cosine) {
    const glm::dvec2 r = fresnel_parts(cosine), t = (1.0 - r) / (1.0 + r);
    return 0.5 * (t.x + t.y);
}

double cosine_at(double x, double y, double h) { return h / std::sqrt(x * x + y * y + h * h); }

// What lies above the floor sends some of its light back, which the closed forms leave out: the floor is
// nearly black, and the light strong.
constexpr double h = 1.2, floor_reflectance = 0.002,
                 intensity = 5 * reflectance / floor_reflectance;  // m, cd
void add_lit_floor(SceneBuilder& s, double x) {
    s.rectangle(cell_size, cell_size, s.lambertian(floor_reflectance), at(x, 0, 0));
    s.light({{"type", "point"}, {"intensity", intensity}}, at(x, 0, h));
}
double lit_floor(double x, double y) { return point_light(x, y, h, 5); }

std::vector<Cell> cells() {
    return {
        {"absorbing slab behind boundaries",
         [](SceneBuilder& s, double x) { add_emitter(s, x), add_slab(s, "boundary", "ink", x, -1.5); },
         [](double x, double) { return emitter_seen(x) * std::exp(-absorption * thickness); }, true},
        {"absorbing glass slab",
         [](SceneBuilder& s, double x) {
             add_emitter(s, x), add_slab(s, "dielectric", "tinted glass", x, -1.5);
         },
         [](double x, double) {
             const double r = fresnel(1), a = std::exp(-absorption * thickness);
             return emitter_seen(x) * (1 - r) * (1 - r) * a / (1 - r * r * a * a);
         },
         true},
        {"alpha 0.5 over an emitter",
         [](SceneBuilder& s, double x) {
             add_emitter(s, x), s.rectangle(1.99, 4, alpha_material(s, 0.5), at(x, 0, -1));
         },
         [](double x, double) { return emitter_seen(x) * 0.5; }, true},
        {"pane over an emitter",
         [](SceneBuilder& s, double x) {
             add_emitter(s, x),
                 s.rectangle(1.99, 4, s.surface({{"class", "thin_dielectric"}, {"ior", ior}}), at(x, 0, -1));
         },
         [](double x, double) { return emitter_seen(x) * pane_transmittance(1); }, true},
        {"point light behind an absorbing slab",
         [](SceneBuilder& s, double x) { add_lit_floor(s, x), add_slab(s, "boundary", "ink", x, 0.3); },
         [](double x, double y) {
             return lit_floor(x, y) * std::exp(-absorption * thickness / cosine_at(x, y, h));
         }},
        {"point light behind a sheet of alpha 0.25",
         [](SceneBuilder& s, double x) {
             add_lit_floor(s, x), s.rectangle(1.99, 4, alpha_material(s, 0.25), at(x, 0, 0.5));
         },
         [](double x, double y) { return 0.75 * lit_floor(x, y); }},
        {"point light behind a pane",
         [](SceneBuilder& s, double x) {
             add_lit_floor(s, x),
                 s.rectangle(1.99, 4, s.surface({{"class", "thin_dielectric"}, {"ior", ior}}), at(x, 0, 0.5));
         },
         [](double x, double y) { return lit_floor(x, y) * pane_transmittance(cosine_at(x, y, h)); }},
        {"point light within an absorbing medium",
         [](SceneBuilder& s, double x) {
             // The camera stands below the slab's lower face; above it all is ink.
             add_lit_floor(s, x);
             s.rectangle(1.99, 4, s.material(inside("boundary", "ink")), facing_down(x, 0, 0.3));
             s.rectangle(1.99, 4, s.material(inside("boundary", "ink")), at(x, 0, 3));
         },
         [](double x, double y) {
             return lit_floor(x, y) * std::exp(-absorption * (h - 0.3) / cosine_at(x, y, h));
         }},
    };
}

}  // namespace

TEST_CASE(
    "light through slabs, panes and alpha is attenuated as it must be, seen directly and by shadow rays") {
    RenderPlan plan;
    plan.passes = 128, plan.seeds = 8;
    check_row(cells(), plan, [](SceneBuilder& scene) {
        scene.medium("ink", {{"absorption", absorption}});
        scene.medium("tinted glass", {{"ior", ior}, {"absorption", absorption}});
    });
}
