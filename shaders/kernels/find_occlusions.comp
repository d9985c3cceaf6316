// Adds what shadow rays bring to their paths (forward: to the splats), unless something stands in the way. A dispatch takes
// rays of which each path has one at most, so no two add to the same.
// Reads: shadow rays, scene. Writes: radiance of the paths or splats, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint counter, first_ray;  // which count; where the rays start
    uint tile_pixels;         // slots of a pass, of backward paths
};
#include "features/splats.glsl"
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#include "stages/trace_shadow.glsl"

void bring(ShadowRay shadow, Brought brought, inout Counters counters) {
#if FORWARD
    if (!is_black(brought) && !add_splat(shadow.target, brought)) counters.non_finite++;
#else
    collect(path_states[shadow.target].radiance, brought);
#endif
}

void begin_pass_of(ShadowRay shadow) {
#if !FORWARD
    begin_pass(shadow.target / tile_pixels);
#endif
}

void main() {
    uint count = queue_counts[counter];
    uint next = gl_GlobalInvocationID.x;
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    Counters counters = no_counters();
    if (SHADOWS_ARE_SEARCHES) {
        // Each lane walks one ray after the other, so that lanes whose rays are short stay at work.
        uint ray = NO_RECORD;
        Traversal walk;
        traversal_end(walk);
        for (;;) {
            if (is_done(walk)) {
                if (ray != NO_RECORD && walk.hit.primitive == NO_RECORD)
                    bring(shadow_rays[ray], brought_by(shadow_rays[ray], analysed(shadow_rays[ray], shadow_rays[ray].contribution)),
                          counters);
                if (next >= count) break;
                ray = first_ray + next;
                next += stride;
                counters.shadow_rays++;
                locate_ray(shadow_rays[ray].location);
                traversal_begin(walk, shadow_rays[ray].origin, shadow_rays[ray].direction, shadow_rays[ray].t_max, true);
            }
            traversal_step(walk, true);
        }
    } else {
        for (; next < count; next += stride) {
            ShadowRay shadow = shadow_rays[first_ray + next];
            begin_pass_of(shadow);
            bring(shadow, trace_shadow(shadow, counters), counters);
        }
    }
    store_counters(counters);
}
