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

void collect_escape(inout Path path, inout Counters counters) {
    counters.escaped += luminance(path.throughput);
    [[unroll]] for (uint light = 0u; light < uint(INFINITE_LIGHT_COUNT); ++light)
        path.radiance += collect_light(path, light, LightHit(vec3(0), vec3(0), vec2(0), vec2(0)));
}

// The end of a ray towards a sampled point of a light lies short of the light by the rounding error of both points, so
// that the light does not hide itself while anything a hair in front of it still does.
float shadow_t_max(vec3 origin, float distance) {
    vec3 a = abs(origin);
    return distance * (1.0 - 8.0 * EPSILON) - 32.0 * EPSILON * (max(a.x, max(a.y, a.z)) + distance);
}

ShadowRay connect_light(inout Path path, SurfacePoint p, ScatteringPoint s) {
    ShadowRay shadow = ShadowRay(vec3(0), vec3(0, 0, 1), 0.0, Spectrum(0), NO_RECORD);
    vec2 u = sample_2d(path.random);
    uint light = 0u;
    float probability = 1.0;
#if LIGHT_COUNT > 1
    float unused;
    light = select_light(p.position, sample_1d(path.random), probability, unused);
#endif
    if (!(probability > 0.0)) return shadow;
    LightSample l = light_sample_towards(lights[light], p.position, u);
    float pdf = l.pdf * probability;
    if (!(pdf > 0.0) || is_black(l.radiance)) return shadow;
    float pdf_scatter;
    Spectrum f = scattering_eval(s, l.direction, pdf_scatter);
    if (is_black(f)) return shadow;
    float weight = l.is_delta ? 1.0 : power_heuristic(pdf, pdf_scatter);
    shadow.contribution = path.throughput * f * l.radiance * (weight / pdf);
    shadow.origin = offset_origin(p.position, p.error, p.geometric_normal, l.direction);
    shadow.direction = l.direction;
    shadow.t_max = l.distance >= INFINITY ? INFINITY : max(0.0, shadow_t_max(shadow.origin, l.distance));
    shadow.medium = scattering_medium(s, l.direction);
    return shadow;
}

// Chooses where the path goes on. False: it is absorbed.
bool scatter_surface(inout Path path, SurfacePoint p, ScatteringPoint s) {
    BsdfSample b = surface_sample(s.surface, s.context, s.wo, sample_3d(path.random));
    if (b.event == EVENT_NONE || is_black(b.weight)) return false;
    vec3 direction = (b.event & EVENT_STRAIGHT) != 0u ? path.direction : normalize(s.frame * b.wi);
    float side = dot(direction, s.normal);
    // A direction that the shading frame puts on one side of the surface and the surface on the other carries nothing.
    if ((b.event & EVENT_STRAIGHT) == 0u && side * b.wi.z <= 0.0) return false;
    path.throughput *= b.weight;
    path.origin = offset_origin(p.position, p.error, p.geometric_normal, direction);
    path.direction = direction;
    path.medium = scattering_medium(s, direction);
    if ((b.event & EVENT_STRAIGHT) == 0u) {
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
    shadow = ShadowRay(vec3(0), vec3(0, 0, 1), 0.0, Spectrum(0), NO_RECORD);
    // cross_media
#if HAS_MEDIA
    if (path.medium != NO_RECORD) path.throughput *= medium_transmittance(path.medium, hit.t);
#endif
    // collect_emission
    if (hit.primitive == NO_RECORD) {
        collect_escape(path, counters);
        return false;
    }
    SurfacePoint p = locate(hit, path.origin, path.direction);
    if (p.light != NO_RECORD)
        path.radiance += collect_light(path, p.light, LightHit(p.position, p.geometric_normal, p.uv0, p.uv1));
    ScatteringPoint s = scattering_point(p, path.direction, path.medium, false);
    // connect_lights
#if LIGHT_COUNT > 0
    if (!surface_is_delta(s.surface, s.context)) shadow = connect_light(path, p, s);
#endif
    // scatter_surfaces
    if (!scatter_surface(path, p, s) || !survive_roulette(path)) return false;
    if (++path.depth >= MAX_DEPTH) {
        counters.depth_limit++;
        counters.depth_limit_lost += luminance(path.throughput);
        return false;
    }
    return true;
}
