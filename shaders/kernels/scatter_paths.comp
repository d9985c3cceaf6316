// One event of every path in the queue, backward or forward: media crossed, emission collected, shadow rays and a new
// direction chosen. With SCATTER_CLASS only the paths that sort_hits has dealt to that class (ONLY_SURFACE_CLASS is its tag).
// Reads: the ray queue of this bounce, hits, paths, scene; backward: forward vertices. Writes: paths, the shadow rays
// and the ray queue of the next bounce with their counts, counters; forward: vertices. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint bounce, read_queue, write_queue;  // bounce within the counts; where the queues start
#if FORWARD
    uint first_path;
#else
    uint slots;        // that there are
    uint tile_pixels;  // slots of a pass
#endif
};
#include "features/class_queues.glsl"
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#if FORWARD
#include "stages/scatter_forward_path.glsl"
#else
#include "stages/scatter_path.glsl"
#endif

// Returns whether the path goes on.
bool scatter(uint slot, inout Counters counters, inout ShadowRay shadow, inout ShadowRay vertex_shadow) {
    Path path = path_states[slot];
#if FORWARD
    bool alive = scatter_forward_path(path, hits[slot], first_path + slot, counters, shadow);
    if (!alive) end_forward_path(first_path + slot, path);
#else
    begin_pass(slot / tile_pixels);
    bool alive = scatter_path(path, hits[slot], counters, shadow, vertex_shadow);
    shadow.target = vertex_shadow.target = slot;
#endif
    store_path(slot, path);
    return alive;
}

void main() {
    uint counts = COUNTS_A_BOUNCE * bounce;
    uint count = paths_to_scatter(bounce);
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    Counters counters = no_counters();
    // All lanes of a group go round together, so that they can append together.
    for (uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x; first < count; first += stride) {
        uint i = first + gl_LocalInvocationID.x;
        bool alive = false;
        ShadowRay shadow = no_shadow_ray(), vertex_shadow = no_shadow_ray();
        uint slot = 0u;
        if (i < count) {
            slot = path_to_scatter(read_queue + i);
            counters.rays++;
            alive = scatter(slot, counters, shadow, vertex_shadow);
        }
        uint place = append(counts + COUNTS_A_BOUNCE, alive);
        if (alive) ray_queue[write_queue + place] = slot;
        append_shadow_ray(shadow, 0u, counts + 1u);
#if !FORWARD
        if (SHADOW_RAYS > 1u) append_shadow_ray(vertex_shadow, slots, counts + 2u);
#endif
    }
    store_counters(counters);
}
