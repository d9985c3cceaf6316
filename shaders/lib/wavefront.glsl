// Paths in memory between the kernels of a pass. A slot holds one path; a queue lists the slots that are still alive.
//
// Slots are dealt to samples of pixels: slot = sample * tile_pixels + pixel within the tile. Ray state is split by who
// reads it: find_hits needs the first two arrays only.
#include "lib/constants.glsl"
#include "lib/path.glsl"

layout(scalar, set = 0) buffer RayOrigins { vec4 ray_origins[]; };        // xyz, w pdf of the direction
layout(scalar, set = 0) buffer RayDirections { vec4 ray_directions[]; };  // xyz, w t_max

struct PathState {
    Spectrum throughput;
    uint depth;
    Spectrum radiance;
    uint medium;
    vec3 reference;
    uint dimension;  // of the sampler
};
layout(scalar, set = 0) buffer PathStates { PathState path_states[]; };

struct ShadowState {
    vec3 origin;
    float t_max;
    vec3 direction;
    uint slot;
    Spectrum contribution;
    uint medium;
};
layout(scalar, set = 0) buffer ShadowRays { ShadowState shadow_rays[]; };

layout(scalar, set = 0) buffer RayQueue { uint ray_queue[]; };    // two of them, one behind the other: read and written in turn
layout(scalar, set = 0) buffer QueueCounts { uint queue_counts[]; };  // of bounce b: rays at 2 b, shadow rays at 2 b + 1

// With a kernel for each class of surfaces: a queue for each, and its count at bounce * SCATTER_CLASS_COUNT + class.
layout(scalar, set = 0) buffer ClassQueues { uint class_queues[]; };
layout(scalar, set = 0) buffer ClassCounts { uint class_counts[]; };

struct Tile {
    uint first_pixel, pixels, first_sample, width, height, seed;
};

Sampler slot_sampler(Tile tile, uint slot, uint dimension) {
    uint pixel = tile.first_pixel + slot % tile.pixels;
    Sampler random = start_sampler(uvec2(pixel % tile.width, pixel / tile.width), tile.first_sample + slot / tile.pixels, tile.seed);
    random.dimension = dimension;
    return random;
}

void store_path(uint slot, Path path) {
    ray_origins[slot] = vec4(path.origin, path.pdf);
    ray_directions[slot] = vec4(path.direction, INFINITY);
    path_states[slot] = PathState(path.throughput, path.depth, path.radiance, path.medium, path.reference, path.random.dimension);
}

Path load_path(Tile tile, uint slot) {
    PathState s = path_states[slot];
    vec4 origin = ray_origins[slot];
    Path path;
    path.origin = origin.xyz;
    path.pdf = origin.w;
    path.direction = ray_directions[slot].xyz;
    path.throughput = s.throughput;
    path.depth = s.depth;
    path.radiance = s.radiance;
    path.medium = s.medium;
    path.reference = s.reference;
    path.random = slot_sampler(tile, slot, s.dimension);
    return path;
}

// The next free place of a queue: one atomic for all lanes of the subgroup that want one.
uint append(uint counter, bool wanted) {
    uvec4 ballot = subgroupBallot(wanted);
    uint first = 0u;
    if (subgroupElect()) first = atomicAdd(queue_counts[counter], subgroupBallotBitCount(ballot));
    return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(ballot);
}
