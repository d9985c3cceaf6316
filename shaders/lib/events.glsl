// What befalls a path at a surface or within a medium, whichever way it goes.
#include "features/bending.glsl"
#include "features/light_layers.glsl"
#include "features/mis.glsl"
#include "features/polarization.glsl"
#include "features/receptors.glsl"
#include "features/recording.glsl"
#include "features/straight.glsl"

// Takes a path through its medium to what it hits, or to where it scatters before. True: it scatters, hit.t metres on.
bool cross_medium(inout Path path, inout Hit hit) {
    MediumRay ray = MediumRay(path.origin, path.direction, hit.t, mode_of(path));
    if (scatters_rays(path.around.medium)) return scatter_within(path, hit, ray);
    if (HAS_MEDIA == 1) {
        if (path.around.medium != NO_RECORD)
            path.throughput *= medium_pass(path.around.medium, ray, sample_seed(path.random)).transmittance;
    }
    return false;
}

// A ray from p that ends short of what lies at `distance` along `direction`, where the path scatters by `pair`. `others`: see
// weigh().
ShadowRay shadow_ray(Path path, SurfacePoint p, ScatteringPoint s, Scattering pair, vec3 direction, float distance,
                     Spectrum contribution, float others) {
    ShadowRay shadow = no_shadow_ray();
    shadow.contribution = contribution;
    shadow.origin = offset_origin(p.position, p.error, p.geometric_normal, direction);
    shadow.direction = direction;
    shadow.t_max = distance >= INFINITY ? INFINITY : max(0.0, shadow_t_max(shadow.origin, distance));
    shadow.around = surroundings_towards(s, direction);
    locate_shadow(shadow, path);
    if (bends_rays(shadow.around.medium)) shadow.t_max = 0.0;
    polarize_shadow(shadow, path, s, pair.mueller);
    turn_history(shadow, path, s);
    weigh(shadow, others);
    weigh_apart(shadow, 0.0);
    return shadow;
}

// The path goes on along the sampled direction. False: it is absorbed.
bool follow_sample(inout Path path, SurfacePoint p, ScatteringPoint s, SurfaceEvent event, VertexMis mis) {
    prefer_azimuth(path, s, event);
    BsdfSample b = event.next;
    record_event(path, p, b.event);
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
#else
    event.next_pdf_reverse *= frame_probability(s, direction, -path.direction);
#endif
    part_at_interface(path, (b.event & EVENT_PARTS) != 0u);
    path.throughput *= b.weight;
    polarize(path, s, event.next_mueller, direction);
    go_through(path, s, direction, straight);
    if (!straight) {
        // What goes straight on stays a candidate for light sampling at the event before.
        leave_receptor(path);
        update_mis(path, mis, s.material, b, event.next_pdf_reverse, catch_density(s, direction));
        path.pdf = (b.event & EVENT_DELTA) != 0u ? 0.0 : b.pdf;
        path.reference = p.position;
        start_passage(path);
    }
    path.origin = origin_of_next(path, p, direction, straight);
    path.direction = direction;
    path.around = surroundings_towards(s, direction);
    settle(path);
    keep_mode(path, event.mode);
    record_departure();
    return true;
}

// Russian roulette on what the path still carries. Radiance that has entered a dense medium is scaled by 1 / ior² until it
// leaves, which is no reason to end the path. Long paths that keep all they carry end neither where they scatter in a medium nor
// where they are refracted nor within a crystal (`passes`): light scatters thousands of times before it comes out, glass may have
// as many faces, and crystals keep some of what enters them for hundreds of reflections.
bool survive_roulette(inout Path path, bool passes) {
    if (path.depth < 3u) return true;
    float carried = max_component(path.throughput);
    if (HAS_INTERFACES == 1 && FORWARD == 0) {
        float ior = medium_ior(path.around.medium, path.origin);
        carried *= ior * ior;
    }
    float q = min(carried, path.depth < 64u || passes ? 1.0 : 0.95);
    if (q >= 1.0) return true;
    if (sample_1d(path.random) >= q) return false;
    path.throughput *= 1.0 / q;
    return true;
}

// After an event: does the path live on?
bool continue_path(inout Path path, uint event, inout Counters counters) {
    float carried = luminance(path.throughput);
    bool passes = (event & (EVENT_TRANSMIT | EVENT_STRAIGHT)) == EVENT_TRANSMIT || mode_of(path) != MODE_NONE;
    bool survives = survive_roulette(path, passes);
#if FORWARD
    counters.roulette += carried - (survives ? luminance(path.throughput) : 0.0);
#endif
    if (!survives) return false;
    if (++path.depth < MAX_DEPTH) return true;
    cut_path(path, counters);
    return false;
}
