// find_hits: the nearest hit of every ray of a queue.
// Reads: ray_origins (xyz), ray_directions (xyz, w = t_max), and with HAS_RAY_QUEUE the queue of ray indices.
// Writes: hits (t, uv, primitive), and with HAS_INSTANCES hit_instances. No barrier.
// Each lane walks one ray after the other, statically strided, so that lanes whose rays are short stay at work.
#include "lib/traversal.glsl"

#ifndef ANY_HIT
#define ANY_HIT 0
#endif

layout(local_size_x = 64) in;

layout(scalar) readonly buffer RayOrigins { vec4 ray_origins[]; };
layout(scalar) readonly buffer RayDirections { vec4 ray_directions[]; };
layout(scalar) writeonly buffer Hits { vec4 hits[]; };
#if HAS_INSTANCES
layout(scalar) writeonly buffer HitInstances { uint hit_instances[]; };
#endif
#if HAS_RAY_QUEUE
layout(scalar) readonly buffer RayQueue { uint ray_queue[]; };
layout(scalar) readonly buffer QueueCounts { uint queue_counts[]; };
layout(push_constant, scalar) uniform Push { uint counter, read_queue; };  // which count; where the queue starts
#define RAY_COUNT queue_counts[counter]
#define QUEUED_RAY(i) ray_queue[read_queue + i]
#else
layout(push_constant, scalar) uniform Push { uint ray_count; };
#define RAY_COUNT ray_count
#define QUEUED_RAY(i) i
#endif

void store_hit(uint ray, Hit hit) {
    hits[ray] = vec4(hit.t, hit.uv, uintBitsToFloat(hit.primitive));
#if HAS_INSTANCES
    hit_instances[ray] = hit.instance;
#endif
}

void main() {
    uint count = RAY_COUNT;
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint next = gl_GlobalInvocationID.x;
#if HAS_UNROLLED_TRAVERSAL
    for (; next < count; next += stride) {
        uint ray = QUEUED_RAY(next);
        vec4 direction = ray_directions[ray];
        store_hit(ray, find_hit(ray_origins[ray].xyz, direction.xyz, direction.w));
    }
#else
    uint ray = NO_RECORD;
    Traversal walk;
    walk.node = BVH_NOTHING;
    for (;;) {
        if (walk.node == BVH_NOTHING) {
            if (ray != NO_RECORD) store_hit(ray, walk.hit);
            if (next >= count) break;
            ray = QUEUED_RAY(next);
            next += stride;
            vec4 direction = ray_directions[ray];
            traversal_begin(walk, ray_origins[ray].xyz, direction.xyz, direction.w);
        }
        traversal_step(walk, ANY_HIT == 1);
    }
#endif
}
