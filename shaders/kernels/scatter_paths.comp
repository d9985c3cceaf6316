// One event of every path in the queue, backward or forward: media crossed, emission collected, shadow rays and a new
// direction chosen. With SCATTER_CLASS only the paths that sort_hits has dealt to that class (ONLY_SURFACE_CLASS is its tag).
// Reads: the ray queue of this bounce, hits, path state, scene; backward: forward vertices. Writes: path state, the shadow rays
// and the ray queue of the next bounce with their counts, counters; forward: vertices. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint bounce, read_queue, write_queue;  // bounce within the counts; where the queues start
#if FORWARD
    uint first_path;
#else
    uint slots;  // that there are
    uint first_pixel, tile_pixels, first_sample, width, height, seed;
#endif
};
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#if FORWARD
#include "stages/scatter_forward_path.glsl"
#else
#include "stages/scatter_path.glsl"
#endif

layout(scalar, set = 0) readonly buffer Hits { vec4 hits[]; };
#if HAS_INSTANCES
layout(scalar, set = 0) readonly buffer HitInstances { uint hit_instances[]; };
#endif

void main() {
#if FORWARD
    Batch batch = Batch(first_path);
#else
    Batch batch = Batch(first_pixel, tile_pixels, first_sample, width, height, seed);
#endif
    uint counts = COUNTS_A_BOUNCE * bounce;
#ifdef SCATTER_CLASS
    uint count = class_counts[bounce * SCATTER_CLASS_COUNT + SCATTER_CLASS];
#else
    uint count = queue_counts[counts];
#endif
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    Counters counters = no_counters();
    // All lanes of a group go round together, so that they can append together.
    for (uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x; first < count; first += stride) {
        uint i = first + gl_LocalInvocationID.x;
        bool alive = false;
        ShadowRay shadow = no_shadow_ray();
#if CONNECT_VERTICES && !FORWARD
        ShadowRay vertex_shadow = no_shadow_ray();
#endif
        uint slot = 0u;
        if (i < count) {
#ifdef SCATTER_CLASS
            slot = class_queues[read_queue + i];
#else
            slot = ray_queue[read_queue + i];
#endif
            Path path = load_path(batch, slot);
            vec4 h = hits[slot];
            Hit hit = Hit(h.x, h.yz, floatBitsToUint(h.w), NO_RECORD);
#if HAS_INSTANCES
            hit.instance = hit_instances[slot];
#endif
            counters.rays++;
#if FORWARD
            alive = scatter_forward_path(path, hit, first_path + slot, counters, shadow);
            if (!alive) end_forward_path(batch, slot, path);
#elif CONNECT_VERTICES
            alive = scatter_path(path, hit, counters, shadow, vertex_shadow);
#else
            alive = scatter_path(path, hit, counters, shadow);
#endif
            store_path(slot, path);
        }
        uint place = append(counts + COUNTS_A_BOUNCE, alive);
        if (alive) ray_queue[write_queue + place] = slot;
#if FORWARD
        append_shadow_ray(shadow, shadow.pixel, 0u, counts + 1u);
#else
        append_shadow_ray(shadow, slot, 0u, counts + 1u);
#if CONNECT_VERTICES
        append_shadow_ray(vertex_shadow, slot, slots, counts + 2u);
#endif
#endif
    }
    store_counters(counters);
}
