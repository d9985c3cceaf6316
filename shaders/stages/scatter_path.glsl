// One event of a backward path: what the ray meets is crossed, collected, connected to a light and to a forward path,
// merged with forward vertices, and scattered from.
//
// Emission that a ray hits and light that is sampled are two estimators of the same integral. Alone they are weighted by
// the power heuristic (Veach 1997, section 9.2.4), so a path that ends on a light counts fully only where no light sample
// could have made it; with forward rays by features/mis.glsl.
#include "features/forward_only.glsl"
#include "features/light_selection.glsl"
#include "features/meeting.glsl"
#include "lib/events.glsl"
#include "stages/arrive.glsl"

// What `light`, met by the path's ray, brings to the pixel, weighted against the other ways to bring it.
Received collect_light(Path path, uint light, LightHit hit) {
    Spectrum radiance = light_radiance(lights[light], path.direction, hit);
    float others = 0.0;
    if (!hit_stands_alone(path)) {
        float sampling = light_pdf_towards(lights[light], path.reference, path.direction, hit);
        if (sampling > 0.0) sampling *= light_selection_probability(light, path.reference);
        others = others_of_hit(path, light, hit, sampling);
    }
    return seen_light(path, path.throughput * radiance * mis_weight(others), light);
}

// The same of the primitive that is met, or of all that surrounds the scene.
Collected collect_emission(Path path, Arrival a) {
    Collected sum = nothing_collected();
    LightHit hit = LightHit(vec3(0), vec3(0), vec2(0), vec2(0));
    uint light = 0u, end = a.escapes ? uint(INFINITE_LIGHT_COUNT) : 0u;
    if (!a.scatters && !a.escapes) {
        light = a.p.light;
        end = a.p.light + 1u;  // 0 where it is no light
        hit = LightHit(a.p.position, a.p.geometric_normal, a.p.uv0, a.p.uv1);
    }
    if (HAS_LIGHTS)
        for (; light < end; ++light) collect(sum, brought_from(path, light, collect_light(path, light, hit)));
    return sum;
}

// A light for the point: what it would bring if the surface scattered all of it. pdf 0 = none.
LightSample sample_light(inout Path path, vec3 position, out uint light) {
    vec2 u = sample_2d(path.random);
    light = 0u;
    float probability = 1.0;
    if (SELECTS_LIGHTS) light = select_light_at(element_of(path), position, sample_1d(path.random), probability);
    if (!(probability > 0.0)) return no_light_sample();
    LightSample l = light_sample_towards(lights[light], position, u);
    l.pdf *= probability;
    return l;
}

// The shadow ray for a light sample, given how the surface scatters between it and the path.
ShadowRay connect_light(Path path, SurfacePoint p, ScatteringPoint s, LightSample l, uint light, Scattering pair, VertexMis mis) {
    if (!(l.pdf > 0.0) || is_black(l.radiance) || is_black(pair.value)) return no_shadow_ray();
    float others = others_of_light_sample(path, s, l, light, pair, mis);
    ShadowRay shadow =
        shadow_ray(path, p, s, pair, l.direction, l.distance, path.throughput * pair.value * l.radiance / l.pdf, others);
    end_at_light(shadow, light);
    come_to_light(shadow, light);
    return shadow;
}

// Returns whether the path goes on; the shadow rays are to be traced in either case.
bool scatter_path(inout Path path, Hit hit, inout Counters counters, out ShadowRay shadow, out ShadowRay vertex_shadow) {
    shadow = vertex_shadow = no_shadow_ray();
    follow_hero(path);
    Spectrum carried = path.throughput;
    bool scatters = cross_and_merge(path, hit);
    Arrival a = arrive(path, carried, hit, scatters, counters);
    if (!a.is_event) return a.lives;
    add_collected(path.radiance, collect_emission(path, a));
    if (a.escapes) {
        counters.escaped += brightness(path.throughput);
        return false;
    }
    SurfacePoint p = a.p;
    ScatteringPoint s = scattering_at(path, a);
    keep_object(s, a.caught, hit.primitive, hit.instance);
    part_at_interface(path, s.disperses);
    bool is_delta = is_delta_point(s);
    VertexMis mis = vertex_mis(path, p, s);
    if (a.caught) mis.merging = 0.0;
    // connect_lights, scatter_surfaces
    LightSample l = no_light_sample();
    uint light = 0u;
    if (HAS_LIGHTS)
        if (!is_delta && !forward_brings(path)) l = sample_light(path, p.position, light);
    vec3 wi = l.direction * s.frame;
    vec3 u = sample_3d(path.random);
    Connection connection = no_connection(wi);
    if (!is_delta && !within_element(path)) connection = choose_vertex(path, p, s);
    SurfaceEvent event = scattering_event(s, wi, connection.wi, SHADOW_RAYS, u);
    // No light where the shading normal and the surface disagree on which side it is.
    if (HAS_LIGHTS)
        if (is_on_one_side(s, l.direction, wi)) shadow = connect_light(path, p, s, l, light, event.pair, mis);
    bool merges = !is_delta && mis.merging > 0.0 && !mis.along;  // in media where rays merge they have done so
    vertex_shadow = meet_vertices(path, p, s, mis, connection, event.second, merges);
    if (leaves_rest(path, event.next.event) || !follow_sample(path, p, s, event, mis)) return false;
    return continue_path(path, event.next.event, counters);
}
