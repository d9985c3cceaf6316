// Paths in memory between the kernels of a pass, of one direction. A slot holds one path; a queue lists the slots that are
// still alive.
//
// Forward, slots are dealt to consecutive paths of the pass; backward, to samples of pixels: slot = sample * tile_pixels + pixel
// within the tile. The rays to trace stand apart, too: find_hits needs nothing else.
#include "features/bending.glsl"
#include "features/receptors.glsl"
#include "lib/constants.glsl"
#include "lib/hits.glsl"
#include "lib/path.glsl"

layout(scalar, set = 0) buffer PathStates { Path path_states[]; };
layout(scalar, set = 0) buffer RayOrigins { vec4 ray_origins[]; };        // xyz, w location (bits)
layout(scalar, set = 0) buffer RayDirections { vec4 ray_directions[]; };  // xyz, w t_max
// Those towards lights or the receiver; behind them, from `slots` on, those of backward paths towards forward vertices.
layout(scalar, set = 0) buffer ShadowRays { ShadowRay shadow_rays[]; };

layout(scalar, set = 0) buffer RayQueue { uint ray_queue[]; };    // two of them, one behind the other: read and written in turn
layout(scalar, set = 0) buffer QueueCounts { uint queue_counts[]; };
// Of a bounce, in queue_counts: rays, shadow rays, shadow rays towards forward vertices. Twin in host/render/wavefront.cpp.
const uint COUNTS_A_BOUNCE = 3u;

// With a kernel for each class of surfaces: a queue for each, and its count at bounce * SCATTER_CLASS_COUNT + class.
layout(scalar, set = 0) buffer ClassQueues { uint class_queues[]; };
layout(scalar, set = 0) buffer ClassCounts { uint class_counts[]; };

void store_path(uint slot, Path path) {
    float end = begin_ray(path);
    path_states[slot] = path;
    ray_origins[slot] = vec4(path.origin, location_bits(path));
    ray_directions[slot] = vec4(path.direction, end);
}

// The next free place of a queue: one atomic for all lanes of the subgroup that want one.
uint append(uint counter, bool wanted) {
    uvec4 ballot = subgroupBallot(wanted);
    uint first = 0u;
    if (subgroupElect()) first = atomicAdd(queue_counts[counter], subgroupBallotBitCount(ballot));
    return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(ballot);
}

// Queues a shadow ray, if there is one, as number `first` + count of the array. All lanes of a group do this together.
void append_shadow_ray(ShadowRay shadow, uint first, uint counter) {
    bool casts = shadow.t_max > 0.0;
    uint place = append(counter, casts);
    if (casts) shadow_rays[first + place] = shadow;
}
