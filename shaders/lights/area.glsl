// A surface that emits: one record for every emissive triangle or shape. Filled by the host from the scene's
// materials. The emission itself, with its texture and sides, belongs to the material.
//
// Example:
//     {"materials": [{"name": "lamp", "extensions": {"ETD_optics": {
//         "surface": {"class": "absorber"}, "emission": {"luminance": 12}}}}],
//      "nodes": [{"name": "lamp", "translation": [-0.1, 1.75, -0.4], "rotation": [0.5, 0, 0, 0.866], "extensions": {"ETD_optics": {
//         "geometry": {"class": "rectangle", "size": [0.8, 0.3], "material": 1}}}}]}
#include "features/coverage.glsl"
#include "features/emission_maps.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"

struct AreaLight {
    uint primitive;  // of lib/primitives.glsl
    uint material;
};

// From a density per area at a point that is seen along `direction` to one per solid angle; 0 where it has no
// finite value.
float area_solid_angle_pdf(float pdf_area, float distance_squared, float cosine) {
    float pdf = pdf_area * distance_squared / abs(cosine);
    return pdf > 0.0 && pdf < INFINITY ? pdf : 0.0;
}

// A point of the surface, off it on the side of `reference` by more than rounding: the way there meets the light itself no
// earlier, however grazing. Without it a curved light hides part of its own rim.
vec3 lifted_point(GeometrySample g, vec3 reference, float cosine) {
    vec3 a = abs(g.position), b = abs(reference);
    float lift = 8.0 * EPSILON * (max(a.x, max(a.y, a.z)) + max(b.x, max(b.y, b.z)));
    return g.position + (cosine < 0.0 ? lift : -lift) * g.normal;
}

// Density of the rays that leave the surface at a point with this normal on the given side, evenly: directions are in proportion to
// the cosine, which the projected area takes away again.
float area_emission_pdf(AreaLight r, bool front, vec3 normal) {
    bool both = material_emits_both_sides(r.material);
    if (!front && !both) return 0.0;
    return (both ? 0.5 : 1.0) * INV_PI * primitive_pdf(r.primitive, normal);
}

// Radiance that leaves a point, on the side of the geometric normal (front) or the other.
Spectrum area_emission(AreaLight r, bool front, vec3 position) {
    vec2 uv0 = vec2(0), uv1 = vec2(0);
    if (HAS_COVERAGE == 1 || materials[r.material].emission_texture.index != NO_RECORD) primitive_uv(r.primitive, position, uv0, uv1);
    Spectrum radiance = material_emission(r.material, front, uv0, uv1);
    cover(radiance, r.primitive, position, uv0, uv1);
    return radiance;
}

LightSample area_sample_towards(AreaLight r, vec3 point, vec2 u) {
    float density;
    u = map_emission(r.primitive, u, density);
    GeometrySample g = primitive_sample_towards(r.primitive, point, u);
    by_emission(g.pdf, density);
    vec3 d = g.position - point;
    float distance_squared = dot(d, d);
    if (!(distance_squared > 0.0)) return no_light_sample();
    float cosine = dot(g.normal, d) * inversesqrt(distance_squared);
    vec3 lifted = lifted_point(g, point, cosine) - point;
    float distance = length(lifted);
    if (!(distance > 0.0)) return no_light_sample();
    vec3 direction = lifted / distance;
    Spectrum radiance = area_emission(r, cosine < 0.0, g.position);
    float emission_pdf = area_emission_pdf(r, cosine < 0.0, g.normal);
    by_emission(emission_pdf, density);
    return LightSample(direction, distance, radiance, area_solid_angle_pdf(g.pdf, distance_squared, cosine), emission_pdf, false);
}

float area_pdf_towards(AreaLight r, vec3 point, vec3 direction, LightHit hit) {
    vec3 d = hit.position - point;
    float pdf = primitive_pdf_towards(r.primitive, point, hit.position, hit.normal);
    by_emission(pdf, emission_density(r.primitive, hit.position));
    return area_solid_angle_pdf(pdf, dot(d, d), dot(hit.normal, direction));
}

Spectrum area_radiance(AreaLight r, vec3 direction, LightHit hit) {
    Spectrum radiance = material_emission(r.material, dot(hit.normal, direction) < 0.0, hit.uv0, hit.uv1);
    cover(radiance, r.primitive, hit.position, hit.uv0, hit.uv1);
    return radiance;
}

// Evenly over the surface or by its map, and evenly over its sides where both emit.
EmittedRay area_emit(AreaLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    vec3 error;
    float density;
    u_position = map_emission(r.primitive, u_position, density);
    GeometrySample g = primitive_sample(r.primitive, u_position, error);
    by_emission(g.pdf, density);
    bool both = material_emits_both_sides(r.material);
    bool front = true;
    if (both) {
        front = u_direction.x < 0.5;
        u_direction.x = 2.0 * u_direction.x - (front ? 0.0 : 1.0);
    }
    vec3 normal = front ? g.normal : -g.normal;
    vec3 direction = normalize(frame_around(normal) * warp_cosine_hemisphere(u_direction));
    Spectrum radiance = area_emission(r, front, g.position);
    return EmittedRay(g.position, error, normal, direction, radiance, (both ? 0.5 : 1.0) * INV_PI * g.pdf, false,
                      front);
}

float area_pdf_emit(AreaLight r, SceneBounds bounds, vec3 direction, LightHit hit) {
    float pdf = area_emission_pdf(r, dot(hit.normal, direction) < 0.0, hit.normal);
    by_emission(pdf, emission_density(r.primitive, hit.position));
    return pdf;
}

float area_power(AreaLight r, SceneBounds bounds) {
    float sides = material_emits_both_sides(r.material) ? 2.0 : 1.0;
    return sides * PI * primitive_area(r.primitive) * luminance(untinted_value(materials[r.material].emission)) * emitted_part(r.primitive);
}

void area_bounds(AreaLight r, out vec3 lo, out vec3 hi) { primitive_bounds(r.primitive, lo, hi); }

LightCone area_cone(AreaLight r) {
    LightCone cone = whole_sphere_cone();
    bool planar = attributes_kind(primitives[r.primitive].attributes) == KIND_TRIANGLE;
    if (planar && !material_emits_both_sides(r.material)) {
        cone.axis = primitive_sample_towards(r.primitive, vec3(0), vec2(0.5)).normal;
        cone.cos_normals = 1.0;
    }
    return cone;
}
