// Adds what shadow rays bring to their paths (forward: to the splats), unless something stands in the way. A dispatch takes
// rays of which each path has one at most, so no two add to the same.
// Reads: shadow rays, scene. Writes: radiance of the path states or splats, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint counter, first_ray;  // which count; where the rays start
#if SPECTRAL && !FORWARD
    uint tile_pixels;         // slots of a pass
#endif
};
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#include "stages/trace_shadow.glsl"
#if FORWARD
#include "lib/splats.glsl"
#endif

void bring(uint target, Spectrum brought, inout Counters counters) {
#if FORWARD
    if (!is_black(brought) && !add_splat(target, brought)) counters.non_finite++;
#else
    path_states[target].radiance += brought;
#endif
}

ShadowRay shadow_ray_of(ShadowState s) {
    ShadowRay ray = no_shadow_ray();
    ray.origin = s.origin, ray.direction = s.direction, ray.t_max = s.t_max;
    ray.contribution = s.contribution;
    ray.medium = s.medium;
#if HAS_PRIORITIES
    ray.bodies = s.bodies;
#endif
#if HAS_SCATTERING
    ray.others = s.others;
#if BEAMS
    ray.others_apart = s.others_apart;
#endif
#endif
    return ray;
}

void main() {
    uint count = queue_counts[counter];
    uint next = gl_GlobalInvocationID.x;
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    Counters counters = no_counters();
#if HAS_STRAIGHT || HAS_MEDIA || HAS_UNROLLED_TRAVERSAL
    for (; next < count; next += stride) {
        ShadowState s = shadow_rays[first_ray + next];
#if SPECTRAL && !FORWARD
        batch_pass = s.target / tile_pixels;
#endif
        bring(s.target, trace_shadow(shadow_ray_of(s), counters), counters);
    }
#else
    // Each lane walks one ray after the other, so that lanes whose rays are short stay at work.
    uint ray = NO_RECORD;
    Traversal walk;
    walk.node = BVH_NOTHING;
    for (;;) {
        if (walk.node == BVH_NOTHING) {
            if (ray != NO_RECORD && walk.hit.primitive == NO_RECORD)
                bring(shadow_rays[ray].target, shadow_rays[ray].contribution, counters);
            if (next >= count) break;
            ray = first_ray + next;
            next += stride;
            counters.shadow_rays++;
            ShadowState s = shadow_rays[ray];
            traversal_begin(walk, s.origin, s.direction, s.t_max);
        }
        traversal_step(walk, true);
    }
#endif
    store_counters(counters);
}
