// find_hits: the nearest hit of every ray of a queue, or with ANY_HIT any.
// Reads: ray_origins (xyz, w = location), ray_directions (xyz, w = t_max), with HAS_RAY_QUEUE the queue of ray indices. Writes: hits. No barrier.
// Each lane walks one ray after the other, statically strided, so that lanes whose rays are short stay at work.
#include "features/defaults.glsl"
#include "features/ray_queue.glsl"
#include "lib/hits.glsl"

layout(local_size_x = 64) in;

layout(scalar) readonly buffer RayOrigins { vec4 ray_origins[]; };
layout(scalar) readonly buffer RayDirections { vec4 ray_directions[]; };

void main() {
    uint count = queued_rays();
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint next = gl_GlobalInvocationID.x;
    uint ray = NO_RECORD;
    Traversal walk;
    traversal_end(walk);
    for (;;) {
        if (is_done(walk)) {
            if (ray != NO_RECORD) hits[ray] = walk.hit;
            if (next >= count) break;
            ray = queued_ray(next);
            next += stride;
            vec4 direction = ray_directions[ray];
            locate_ray(floatBitsToUint(ray_origins[ray].w));
            traversal_begin(walk, ray_origins[ray].xyz, direction.xyz, direction.w, ANY_HIT == 1);
        }
        traversal_step(walk, ANY_HIT == 1);
    }
}
