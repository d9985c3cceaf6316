// One event of every path in the queue: media crossed, emission collected, a light sampled, a new direction chosen.
// With SCATTER_CLASS only the paths that sort_hits has dealt to that class (ONLY_SURFACE_CLASS is its tag).
// Reads: the ray queue of this bounce, hits, path state, scene. Writes: path state, the shadow rays and the ray queue of
// the next bounce with their counts, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint bounce, read_queue, write_queue;  // bounce within the counts; where the queues start
    uint first_pixel, tile_pixels, first_sample, width, height, seed;
};
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#include "stages/scatter_path.glsl"

layout(scalar, set = 0) readonly buffer Hits { vec4 hits[]; };
#if HAS_INSTANCES
layout(scalar, set = 0) readonly buffer HitInstances { uint hit_instances[]; };
#endif

void main() {
    Tile tile = Tile(first_pixel, tile_pixels, first_sample, width, height, seed);
#ifdef SCATTER_CLASS
    uint count = class_counts[bounce * SCATTER_CLASS_COUNT + SCATTER_CLASS];
#else
    uint count = queue_counts[2u * bounce];
#endif
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    Counters counters = no_counters();
    // All lanes of a group go round together, so that they can append together.
    for (uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x; first < count; first += stride) {
        uint i = first + gl_LocalInvocationID.x;
        bool alive = false;
        ShadowRay shadow = no_shadow_ray();
        uint slot = 0u;
        if (i < count) {
#ifdef SCATTER_CLASS
            slot = class_queues[read_queue + i];
#else
            slot = ray_queue[read_queue + i];
#endif
            Path path = load_path(tile, slot);
            vec4 h = hits[slot];
            Hit hit = Hit(h.x, h.yz, floatBitsToUint(h.w), NO_RECORD);
#if HAS_INSTANCES
            hit.instance = hit_instances[slot];
#endif
            counters.rays++;
            alive = scatter_path(path, hit, counters, shadow);
            store_path(slot, path);
        }
        uint place = append(2u * bounce + 2u, alive);
        if (alive) ray_queue[write_queue + place] = slot;
        bool casts = shadow.t_max > 0.0;
        place = append(2u * bounce + 1u, casts);
        if (casts)
            shadow_rays[place] = ShadowState(shadow.origin, shadow.t_max, shadow.direction, slot, shadow.contribution, shadow.medium);
    }
    store_counters(counters);
}
