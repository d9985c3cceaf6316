// Paths in memory between the kernels of a pass, of one direction. A slot holds one path; a queue lists the slots that are
// still alive.
//
// Forward, slots are dealt to consecutive paths of the pass; backward, to samples of pixels: slot = sample * tile_pixels + pixel
// within the tile. Ray state is split by who reads it: find_hits needs the first two arrays only. What the techniques of
// lib/path.glsl do not need takes no room; the host sizes the arrays in host/render/wavefront.cpp.
#include "lib/constants.glsl"
#include "lib/bending.glsl"
#include "lib/path.glsl"
#if FORWARD
#include "lib/forward_pass.glsl"
#endif

layout(scalar, set = 0) buffer RayOrigins { vec4 ray_origins[]; };        // xyz, w pdf of the direction
layout(scalar, set = 0) buffer RayDirections { vec4 ray_directions[]; };  // xyz, w t_max

struct PathState {
    Spectrum throughput;
    uint depth;
    vec3 reference;
    uint medium;
    uint dimension;  // of the sampler
#if HAS_BENDING
    Bend bend;
#endif
#if HAS_PRIORITIES
    Bodies bodies;
#endif
#if HAS_SCATTERING
    float passage;
#endif
#if !FORWARD
    Spectrum radiance;
#endif
#if BIDIRECTIONAL
    float vcm, vc, pending;
#if FORWARD
    uint light;
    vec3 light_normal;
#endif
#endif
#if HAS_PATH_FLAGS
    uint flags;
#endif
#if FORWARD
    uvec2 vertices;
#elif MERGE_VERTICES
    Spectrum bias;
#endif
};
layout(scalar, set = 0) buffer PathStates { PathState path_states[]; };

struct ShadowState {
    vec3 origin;
    float t_max;
    vec3 direction;
    uint target;  // what it contributes to: a slot; forward: a pixel
    Spectrum contribution;
    uint medium;
#if HAS_PRIORITIES
    Bodies bodies;
#endif
#if HAS_SCATTERING
    float others;
#if BEAMS
    float others_apart;
#endif
#endif
};
// Those towards lights or the receiver; behind them, from `slots` on, those of backward paths towards forward vertices.
layout(scalar, set = 0) buffer ShadowRays { ShadowState shadow_rays[]; };

layout(scalar, set = 0) buffer RayQueue { uint ray_queue[]; };    // two of them, one behind the other: read and written in turn
layout(scalar, set = 0) buffer QueueCounts { uint queue_counts[]; };
// Of a bounce, in queue_counts: rays, shadow rays, shadow rays towards forward vertices. Twin in host/render/wavefront.cpp.
const uint COUNTS_A_BOUNCE = 3u;

// With a kernel for each class of surfaces: a queue for each, and its count at bounce * SCATTER_CLASS_COUNT + class.
layout(scalar, set = 0) buffer ClassQueues { uint class_queues[]; };
layout(scalar, set = 0) buffer ClassCounts { uint class_counts[]; };

// What the slots hold.
struct Batch {
#if FORWARD
    uint first_path;
#else
    uint first_pixel, tile_pixels, first_sample, width, height, seed;
#endif
};

Sampler slot_sampler(Batch batch, uint slot, uint dimension) {
#if FORWARD
    Sampler random =
        start_forward_sampler(forward_pass.pass, batch.first_path + slot, forward_pass.count, forward_pass.seed);
#else
    uint pixel = batch.first_pixel + slot % batch.tile_pixels;
    Sampler random = start_sampler(uvec2(pixel % batch.width, pixel / batch.width),
                                   batch.first_sample + slot / batch.tile_pixels, batch.seed);
#endif
    random.dimension = dimension;
    return random;
}

void store_path(uint slot, Path path) {
    float end = begin_ray(path);
    ray_origins[slot] = vec4(path.origin, path.pdf);
    ray_directions[slot] = vec4(path.direction, end);
    PathState s;
    s.throughput = path.throughput;
    s.depth = path.depth;
    s.reference = path.reference;
    s.medium = path.medium;
    s.dimension = path.random.dimension;
#if HAS_BENDING
    s.bend = path.bend;
#endif
#if HAS_PRIORITIES
    s.bodies = path.bodies;
#endif
#if HAS_SCATTERING
    s.passage = path.passage;
#endif
#if !FORWARD
    s.radiance = path.radiance;
#endif
#if BIDIRECTIONAL
    s.vcm = path.vcm, s.vc = path.vc, s.pending = path.pending;
#if FORWARD
    s.light = path.light;
    s.light_normal = path.light_normal;
#endif
#endif
#if HAS_PATH_FLAGS
    s.flags = path.flags;
#endif
#if FORWARD
    s.vertices = path.vertices;
#elif MERGE_VERTICES
    s.bias = path.bias;
#endif
    path_states[slot] = s;
}

Path load_path(Batch batch, uint slot) {
#if SPECTRAL && !FORWARD
    batch_pass = slot / batch.tile_pixels;
#endif
    PathState s = path_states[slot];
    vec4 origin = ray_origins[slot];
    Path path;
    path.origin = origin.xyz;
    path.pdf = origin.w;
    path.direction = ray_directions[slot].xyz;
    path.throughput = s.throughput;
    path.depth = s.depth;
#if HAS_BENDING
    path.bend = s.bend;
#endif
    path.reference = s.reference;
    path.medium = s.medium;
#if HAS_PRIORITIES
    path.bodies = s.bodies;
#endif
#if HAS_SCATTERING
    path.passage = s.passage;
#endif
    path.random = slot_sampler(batch, slot, s.dimension);
#if FORWARD
    path.radiance = Spectrum(0);
#else
    path.radiance = s.radiance;
#endif
#if BIDIRECTIONAL
    path.vcm = s.vcm, path.vc = s.vc, path.pending = s.pending;
#if FORWARD
    path.light = s.light;
    path.light_normal = s.light_normal;
#endif
#endif
#if HAS_PATH_FLAGS
    path.flags = s.flags;
#endif
#if FORWARD
    path.vertices = s.vertices;
#elif MERGE_VERTICES
    path.bias = s.bias;
#endif
    return path;
}

// The next free place of a queue: one atomic for all lanes of the subgroup that want one.
uint append(uint counter, bool wanted) {
    uvec4 ballot = subgroupBallot(wanted);
    uint first = 0u;
    if (subgroupElect()) first = atomicAdd(queue_counts[counter], subgroupBallotBitCount(ballot));
    return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(ballot);
}

// Queues a shadow ray, if there is one, as number `first` + count of the array. All lanes of a group do this together.
void append_shadow_ray(ShadowRay shadow, uint target, uint first, uint counter) {
    bool casts = shadow.t_max > 0.0;
    uint place = append(counter, casts);
    if (casts)
        shadow_rays[first + place] =
            ShadowState(shadow.origin, shadow.t_max, shadow.direction, target, shadow.contribution, shadow.medium
#if HAS_PRIORITIES
                        , shadow.bodies
#endif
#if HAS_SCATTERING
                        , shadow.others
#if BEAMS
                        , shadow.others_apart
#endif
#endif
            );
}

#if FORWARD
#if CONNECT_VERTICES
layout(scalar, set = 0) writeonly buffer PathEnds { uvec2 path_ends[]; };  // per path: last stored vertex, their number
void end_forward_path(Batch batch, uint slot, Path path) { path_ends[batch.first_path + slot] = path.vertices; }
#else
void end_forward_path(Batch batch, uint slot, Path path) {}
#endif
#endif
