// Adds to each path what its shadow ray brings, unless something stands in the way.
// Reads: shadow rays of this bounce, scene. Writes: radiance of the path states, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint bounce; };
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#include "stages/trace_shadow.glsl"

void main() {
    uint count = queue_counts[2u * bounce + 1u];
    uint next = gl_GlobalInvocationID.x;
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    Counters counters = no_counters();
#if HAS_STRAIGHT || HAS_MEDIA || HAS_UNROLLED_TRAVERSAL
    for (; next < count; next += stride) {
        ShadowState s = shadow_rays[next];
        path_states[s.slot].radiance += trace_shadow(ShadowRay(s.origin, s.direction, s.t_max, s.contribution, s.medium), counters);
    }
#else
    // Each lane walks one ray after the other, so that lanes whose rays are short stay at work.
    uint ray = NO_RECORD;
    Traversal walk;
    walk.node = BVH_NOTHING;
    for (;;) {
        if (walk.node == BVH_NOTHING) {
            if (ray != NO_RECORD && walk.hit.primitive == NO_RECORD)
                path_states[shadow_rays[ray].slot].radiance += shadow_rays[ray].contribution;
            if (next >= count) break;
            ray = next;
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
