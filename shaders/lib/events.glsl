// What befalls a path at a surface or within a medium, whichever way it goes.
#include "lib/bending.glsl"
#include "lib/mis.glsl"

// The end of a ray towards a sampled point of a light lies short of the light by the rounding error of both points, so
// that the light does not hide itself while anything a hair in front of it still does.
float shadow_t_max(vec3 origin, float distance) {
    vec3 a = abs(origin);
    return distance * (1.0 - 8.0 * EPSILON) - 32.0 * EPSILON * (max(a.x, max(a.y, a.z)) + distance);
}

// Takes a path through its medium to what it hits, or to where it scatters before. True: it scatters, hit.t metres on.
bool cross_medium(inout Path path, inout Hit hit) {
    MediumRay ray = MediumRay(path.origin, path.direction, hit.t);
#if HAS_SCATTERING
    if (medium_scatters(path.medium)) {
        vec2 u = sample_2d(path.random);
        FreePath free = medium_free_path(path.medium, ray, path.throughput, u, sample_seed(path.random));
        path.throughput *= free.weight;
        path.passage *= free.passage;
        // Never on the other side of what it would have hit, by rounding.
        if (free.scatters) hit.t = min(free.distance, max(0.0, shadow_t_max(path.origin, hit.t)));
        return free.scatters;
    }
#endif
#if HAS_MEDIA
    if (path.medium != NO_RECORD) path.throughput *= medium_pass(path.medium, ray, sample_seed(path.random)).transmittance;
#endif
    return false;
}

// A ray from p that ends short of what lies at `distance` along `direction`. `others`: see weigh().
ShadowRay shadow_ray(SurfacePoint p, ScatteringPoint s, vec3 direction, float distance, Spectrum contribution, float others) {
    ShadowRay shadow = no_shadow_ray();
    shadow.contribution = contribution;
    shadow.origin = offset_origin(p.position, p.error, p.geometric_normal, direction);
    shadow.direction = direction;
    shadow.t_max = distance >= INFINITY ? INFINITY : max(0.0, shadow_t_max(shadow.origin, distance));
#if HAS_PRIORITIES
    shadow.bodies = scattering_bodies(s, direction);
    shadow.medium = medium_among(shadow.bodies);
#else
    shadow.medium = scattering_medium(s, direction);
#endif
#if HAS_BENDING
    if (medium_bends(shadow.medium)) shadow.t_max = 0.0;
#endif
    weigh(shadow, others);
    return shadow;
}

#ifdef RECORD_PATHS
// For kernels/record_paths.comp.
struct RecordedEvent {
    vec3 position;
    uint event, material, light;
    float arriving;  // luminance of what the path carries there
    bool happened, followed;
};
RecordedEvent recorded_event;
#endif

// The path goes on along the sampled direction. False: it is absorbed.
bool follow_sample(inout Path path, SurfacePoint p, ScatteringPoint s, SurfaceEvent event, VertexMis mis) {
    BsdfSample b = event.next;
#ifdef RECORD_PATHS
    recorded_event = RecordedEvent(p.position, b.event, p.material, p.light, luminance(path.throughput), true, false);
#endif
    if (b.event == EVENT_NONE || is_black(b.weight)) return false;
    bool straight = (b.event & EVENT_STRAIGHT) != 0u;
    vec3 direction = straight ? path.direction : normalize(s.frame * b.wi);
    // A direction that the shading frame puts on one side of the surface and the surface on the other carries nothing.
    if (!straight && !is_on_one_side(s, direction, b.wi)) return false;
#if FORWARD
    float probability = frame_probability(s, -path.direction, direction);
    if (!is_seen_from(s, direction) || !(probability > 0.0)) return false;
    path.throughput *= adjoint_correction(s, -path.direction, direction) / probability;
    if ((b.event & EVENT_DELTA) == 0u) b.pdf *= probability;
#endif
    path.throughput *= b.weight;
    if (!straight) {
        // What goes straight on stays a candidate for light sampling at the event before.
#if BIDIRECTIONAL
#if !FORWARD
        event.next_pdf_reverse *= frame_probability(s, direction, -path.direction);
#endif
        update_mis(path, mis, s.material, b, event.next_pdf_reverse, catch_density(s, direction));
#endif
        path.pdf = (b.event & EVENT_DELTA) != 0u ? 0.0 : b.pdf;
        path.reference = p.position;
#if HAS_SCATTERING
        path.passage = 1.0;
#endif
    }
#if HAS_STRAIGHT
    if (straight) path.origin = origin_behind(path.origin, p.position, p.error, p.geometric_normal, direction);
    else
#endif
        path.origin = offset_origin(p.position, p.error, p.geometric_normal, direction);
    path.direction = direction;
#if HAS_PRIORITIES
    path.bodies = scattering_bodies(s, direction);
    path.medium = medium_among(path.bodies);
#else
    path.medium = scattering_medium(s, direction);
#endif
#ifdef RECORD_PATHS
    recorded_event.followed = true;
#endif
    return true;
}

// Russian roulette on what the path still carries. Radiance that has entered a dense medium is scaled by 1 / ior² until it
// leaves, which is no reason to end the path. Long paths that keep all they carry end neither where they scatter in a medium nor where
// they are refracted (`passes`): light scatters thousands of times before it comes out, and glass may have as many faces.
bool survive_roulette(inout Path path, bool passes) {
    if (path.depth < 3u) return true;
    float carried = max_component(path.throughput);
#if HAS_INTERFACES && !FORWARD
    float ior = medium_ior(path.medium, path.origin);
    carried *= ior * ior;
#endif
    float q = min(carried, path.depth < 64u || passes ? 1.0 : 0.95);
    if (q >= 1.0) return true;
    if (sample_1d(path.random) >= q) return false;
    path.throughput *= 1.0 / q;
    return true;
}

// After an event: does the path live on?
bool continue_path(inout Path path, uint event, inout Counters counters) {
    float carried = luminance(path.throughput);
    bool survives = survive_roulette(path, (event & (EVENT_TRANSMIT | EVENT_STRAIGHT)) == EVENT_TRANSMIT);
#if FORWARD
    counters.roulette += carried - (survives ? luminance(path.throughput) : 0.0);
#endif
    if (!survives) return false;
    if (++path.depth < MAX_DEPTH) return true;
    counters.depth_limit++;
    counters.depth_limit_lost += luminance(path.throughput);
    return false;
}
