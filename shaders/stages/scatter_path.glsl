// One event of a backward path: what the ray meets is crossed, collected, connected to a light and to a forward path,
// merged with forward vertices, and scattered from.
//
// Emission that a ray hits and light that is sampled are two estimators of the same integral. Alone they are weighted by
// the power heuristic (Veach 1997, section 9.2.4), so a path that ends on a light counts fully only where no light sample
// could have made it; with forward rays by lib/mis.glsl.
#include "lib/events.glsl"
#include "lib/traversal.glsl"
#if CONNECT_VERTICES
#include "stages/meet_vertices.glsl"
#endif
#if BEAMS
#include "stages/merge_along.glsl"
#endif

float passage(Path path) {
#if HAS_SCATTERING
    return path.passage;
#else
    return 1.0;
#endif
}

// Radiance of `light` met by the path's ray, weighted against the other ways to bring it.
Spectrum collect_light(Path path, uint light, LightHit hit) {
    Spectrum radiance = light_radiance(lights[light], path.direction, hit);
    float others = 0.0;
#if BIDIRECTIONAL
    bool alone = (path.flags & PATH_STARTS) != 0u;
#else
    bool alone = !(path.pdf > 0.0);
#endif
    if (!alone) {
        float other = light_pdf_towards(lights[light], path.reference, path.direction, hit);
        if (other > 0.0) other *= light_selection_probability(light, path.reference);
#if BIDIRECTIONAL
        float emission = light_pdf_emit(lights[light], scene_bounds(), path.direction, hit) * emitter_probability(light);
        others = other * path.vcm / passage(path) + emission * path.vc;
#else
        others = other / (path.pdf * passage(path));
#endif
    }
    return path.throughput * radiance * mis_weight(others);
}

// Forward rays alone can bring whatever reaches the receiver from a surface that is not perfectly smooth.
bool forward_brings(Path path) {
#if FORWARD_ONLY
    return (path.flags & PATH_STARTS) != 0u;
#else
    return false;
#endif
}

// A light for the point: what it would bring if the surface scattered all of it. pdf 0 = none.
LightSample sample_light(inout Path path, vec3 position, out uint light) {
    vec2 u = sample_2d(path.random);
    light = 0u;
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

#if LIGHT_COUNT > 0
// The shadow ray for a light sample, given how the surface scatters between it and the path.
ShadowRay connect_light(Path path, SurfacePoint p, ScatteringPoint s, LightSample l, uint light, SurfacePair pair, VertexMis mis) {
    if (!(l.pdf > 0.0) || is_black(l.radiance) || is_black(pair.value)) return no_shadow_ray();
#if BIDIRECTIONAL
    float by_hit = l.is_delta ? 0.0 : pair.pdf;
    float emission = l.emission_pdf * emitter_probability(light) * catch_density(s, l.direction);
    float reverse = pair.pdf_reverse * frame_probability(s, l.direction, -path.direction);
    float others = by_hit + emission * (connects(path) * mis.vcm + reverse * mis.vc);
#else
    float others = l.is_delta ? 0.0 : pair.pdf;
#endif
    return shadow_ray(p, s, l.direction, l.distance, path.throughput * pair.value * l.radiance / l.pdf, others / l.pdf);
}
#endif

// Returns whether the path goes on; the shadow rays are to be traced in either case.
bool scatter_path(inout Path path, Hit hit, inout Counters counters, out ShadowRay shadow
#if CONNECT_VERTICES
                  , out ShadowRay vertex_shadow
#endif
) {
    shadow = no_shadow_ray();
#if CONNECT_VERTICES
    vertex_shadow = no_shadow_ray();
#endif
#if HAS_BENDING
    Spectrum carried = path.throughput;
#endif
#if BEAMS
    Path before = path;
    float to_surface = hit.t;
#endif
    bool scatters = cross_medium(path, hit);
#if BEAMS
    merge_along(path, before, to_surface, hit.t);
#endif
#if HAS_BENDING
    if (is_bent(path) && hit.primitive == NO_RECORD) {
        end_step(path);
        return count_step(path, counters);
    }
#endif
    // collect_emission: of the primitive that is hit, or of all that surrounds the scene
    bool escapes = !scatters && hit.primitive == NO_RECORD;
    SurfacePoint p;
#if HAS_PRIORITIES
    Crossing crossing = Crossing(path.bodies, path.bodies, true);
#endif
    LightHit light_hit = LightHit(vec3(0), vec3(0), vec2(0), vec2(0));
    uint light = 0u, light_end = uint(INFINITE_LIGHT_COUNT);
    if (scatters) {
#if HAS_SCATTERING
        p = volume_point(path.origin + hit.t * path.direction, path.direction);
        light_end = 0u;
#endif
    } else if (!escapes) {
        p = locate(hit, path.origin, path.direction);
#if HAS_PRIORITIES
        crossing = meet_faces(path.origin, path.direction, path.bodies, hit, p);
#endif
#if HAS_BENDING
        if (is_bent(path) && !end_step_at(path, p, hit.t)) {
            path.throughput = carried;
            return count_step(path, counters);
        }
#endif
#if HAS_PRIORITIES
        if (!crossing.is_there) {
            pass_faces(path, p, crossing);
            return true;
        }
#endif
        light = p.light;
        light_end = p.light + 1u;  // 0 where it is no light
        light_hit = LightHit(p.position, p.geometric_normal, p.uv0, p.uv1);
    }
#if LIGHT_COUNT > 0
    for (; light < light_end; ++light) path.radiance += collect_light(path, light, light_hit);
#endif
    if (escapes) {
        counters.escaped += brightness(path.throughput);
        return false;
    }
    ScatteringPoint s;
#if HAS_SCATTERING
    if (scatters) s = volume_scattering_point(p.position, path.direction, path.medium, false);
    else
#endif
#if HAS_PRIORITIES
        s = scattering_point(p, path.direction, medium_above(crossing, p, path.direction));
    set_bodies(s, crossing, path.direction);
#else
        s = scattering_point(p, path.direction, path.medium);
#endif
#if HAS_DISPERSION
    if (s.disperses) make_monochrome(path);
#endif
    bool is_delta = is_delta_point(s);
    VertexMis mis = vertex_mis(path, p, s);
    // connect_lights, scatter_surfaces
    LightSample l = no_light_sample();
#if LIGHT_COUNT > 0
    uint sampled_light = 0u;
    if (!is_delta && !forward_brings(path)) l = sample_light(path, p.position, sampled_light);
#endif
    vec3 wi = l.direction * s.frame;
    vec3 u = sample_3d(path.random);
#if CONNECT_VERTICES
    Connection connection;
    connection.is_there = false, connection.wi = wi;
    if (!is_delta) connection = choose_vertex(path.random, p, s);
    SurfaceEvent event = scattering_event(s, wi, connection.wi, 2u, u);
#else
    SurfaceEvent event = scattering_event(s, wi, wi, 1u, u);
#endif
#if LIGHT_COUNT > 0
    // No light where the shading normal and the surface disagree on which side it is.
    if (is_on_one_side(s, l.direction, wi))
        shadow = connect_light(path, p, s, l, sampled_light, event.pair, mis);
#endif
#if CONNECT_VERTICES
    bool merges = !is_delta && mis.merging > 0.0;
#if BEAMS
    if (mis.along) merges = false;  // the ray has merged
#endif
    vertex_shadow = meet_vertices(path, p, s, mis, connection, event.second, merges);
#endif
#if FORWARD_ONLY
    if (forward_brings(path) && (event.next.event & EVENT_DELTA) == 0u) return false;
    if ((event.next.event & EVENT_STRAIGHT) == 0u) path.flags &= ~PATH_STARTS;
#endif
    if (!follow_sample(path, p, s, event, mis)) return false;
    return continue_path(path, event.next.event, counters);
}
