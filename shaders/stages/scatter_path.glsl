// One event of a backward path: what the ray meets is crossed, collected, connected to a light, and scattered from.
//
// Emission that a ray hits and light that is sampled are two estimators of the same integral; each is weighted by the
// power heuristic (Veach 1997, section 9.2.4), so a path that ends on a light counts fully only where no light sample
// could have made it.
#include "interfaces/light_source.glsl"
#include "lib/light_selection.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"
#include "lib/traversal.glsl"

float power_heuristic(float pdf, float other) {
    // In ratios, so that squares neither overflow nor vanish.
    if (!(pdf > 0.0)) return 0.0;
    float r = other / pdf;
    return 1.0 / (1.0 + r * r);
}

// Radiance of `light` met by the path's ray, weighted against sampling the light at the path's last event.
Spectrum collect_light(Path path, uint light, LightHit hit) {
    Spectrum radiance = light_radiance(lights[light], path.direction, hit);
    float weight = 1.0;
    if (path.pdf > 0.0) {
        float other = light_pdf_towards(lights[light], path.reference, path.direction, hit);
        if (other > 0.0) other *= light_selection_probability(light, path.reference);
        weight = power_heuristic(path.pdf, other);
    }
    return path.throughput * radiance * weight;
}

// The end of a ray towards a sampled point of a light lies short of the light by the rounding error of both points, so
// that the light does not hide itself while anything a hair in front of it still does.
float shadow_t_max(vec3 origin, float distance) {
    vec3 a = abs(origin);
    return distance * (1.0 - 8.0 * EPSILON) - 32.0 * EPSILON * (max(a.x, max(a.y, a.z)) + distance);
}

// A light for the point: what it would bring if the surface scattered all of it. pdf 0 = none.
LightSample sample_light(inout Path path, vec3 position) {
    vec2 u = sample_2d(path.random);
    uint light = 0u;
    float probability = 1.0;
#if LIGHT_COUNT > 1
    float unused;
    light = select_light(position, sample_1d(path.random), probability, unused);
    if (!(probability > 0.0)) return no_light_sample();
#endif
    LightSample l = light_sample_towards(lights[light], position, u);
    l.pdf *= probability;
    return l;
}

// The shadow ray for a light sample, given f * |cos| towards it and the pdf of scattering that way.
ShadowRay connect_light(Path path, SurfacePoint p, ScatteringPoint s, LightSample l, Spectrum value, float pdf_scatter) {
    ShadowRay shadow = no_shadow_ray();
    if (!(l.pdf > 0.0) || is_black(l.radiance) || is_black(value)) return shadow;
    float weight = l.is_delta ? 1.0 : power_heuristic(l.pdf, pdf_scatter);
    shadow.contribution = path.throughput * value * l.radiance * (weight / l.pdf);
    shadow.origin = offset_origin(p.position, p.error, p.geometric_normal, l.direction);
    shadow.direction = l.direction;
    shadow.t_max = l.distance >= INFINITY ? INFINITY : max(0.0, shadow_t_max(shadow.origin, l.distance));
    shadow.medium = scattering_medium(s, l.direction);
    return shadow;
}

// The path goes on along the sampled direction. False: it is absorbed.
bool follow_sample(inout Path path, SurfacePoint p, ScatteringPoint s, BsdfSample b) {
    if (b.event == EVENT_NONE || is_black(b.weight)) return false;
    bool straight = (b.event & EVENT_STRAIGHT) != 0u;
    vec3 direction = straight ? path.direction : normalize(s.frame * b.wi);
    // A direction that the shading frame puts on one side of the surface and the surface on the other carries nothing.
    if (!straight && dot(direction, s.normal) * b.wi.z <= 0.0) return false;
    path.throughput *= b.weight;
    path.origin = offset_origin(p.position, p.error, p.geometric_normal, direction);
    path.direction = direction;
    path.medium = scattering_medium(s, direction);
    if (!straight) {
        // What goes straight on stays a candidate for light sampling at the event before.
        path.pdf = (b.event & EVENT_DELTA) != 0u ? 0.0 : b.pdf;
        path.reference = p.position;
    }
    return true;
}

// Russian roulette on what the path still carries. Radiance that has entered a dense medium is scaled by 1 / ior² until it
// leaves, which is no reason to end the path.
bool survive_roulette(inout Path path) {
    if (path.depth < 3u) return true;
    float carried = max_component(path.throughput);
#if HAS_INTERFACES
    float ior = medium_ior(path.medium);
    carried *= ior * ior;
#endif
    float q = min(carried, path.depth < 64u ? 1.0 : 0.95);
    if (q >= 1.0) return true;
    if (sample_1d(path.random) >= q) return false;
    path.throughput *= 1.0 / q;
    return true;
}

// Returns whether the path goes on; `shadow` is to be traced in either case.
bool scatter_path(inout Path path, Hit hit, inout Counters counters, out ShadowRay shadow) {
    shadow = no_shadow_ray();
    // cross_media
#if HAS_MEDIA
    if (path.medium != NO_RECORD) path.throughput *= medium_transmittance(path.medium, hit.t);
#endif
    // collect_emission: of the primitive that is hit, or of all that surrounds the scene
    bool escapes = hit.primitive == NO_RECORD;
    SurfacePoint p;
    LightHit light_hit = LightHit(vec3(0), vec3(0), vec2(0), vec2(0));
    uint light = 0u, light_end = uint(INFINITE_LIGHT_COUNT);
    if (!escapes) {
        p = locate(hit, path.origin, path.direction);
        light = p.light;
        light_end = p.light + 1u;  // 0 where it is no light
        light_hit = LightHit(p.position, p.geometric_normal, p.uv0, p.uv1);
    }
#if LIGHT_COUNT > 0
    for (; light < light_end; ++light) path.radiance += collect_light(path, light, light_hit);
#endif
    if (escapes) {
        counters.escaped += luminance(path.throughput);
        return false;
    }
    ScatteringPoint s = scattering_point(p, path.direction, path.medium, false);
    // connect_lights, scatter_surfaces
    LightSample l = no_light_sample();
#if LIGHT_COUNT > 0
    if (!surface_is_delta(s.surface, s.context)) l = sample_light(path, p.position);
#endif
    vec3 wi = l.direction * s.frame;
    SurfaceEvent event = surface_event(s.surface, s.context, s.wo, wi, sample_3d(path.random));
    // No light where the shading normal and the surface disagree on which side it is.
    if (wi.z * dot(l.direction, s.normal) > 0.0) shadow = connect_light(path, p, s, l, event.value, event.pdf);
    if (!follow_sample(path, p, s, event.next) || !survive_roulette(path)) return false;
    if (++path.depth >= MAX_DEPTH) {
        counters.depth_limit++;
        counters.depth_limit_lost += luminance(path.throughput);
        return false;
    }
    return true;
}
