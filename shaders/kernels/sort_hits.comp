// Deals the paths of a bounce to one queue for each class of surface that they have hit; what has hit nothing goes to the
// first. Order within a queue does not matter: paths are independent. Where faces coincide, the hit becomes that of the one seen.
// Reads: the ray queue of this bounce, hits, materials. Writes: class queues and their counts. Barrier expected: after the
// dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint bounce, read_queue, slots; };
#include "lib/bvh.glsl"
#include "lib/materials.glsl"
#include "lib/wavefront.glsl"
#if HAS_PRIORITIES
#include "lib/faces.glsl"
layout(scalar, set = 0) buffer Hits { vec4 hits[]; };
#if HAS_INSTANCES
layout(scalar, set = 0) buffer HitInstances { uint hit_instances[]; };
#endif

void settle_hit(uint slot) {
    vec4 h = hits[slot];
    Hit hit = Hit(h.x, h.yz, floatBitsToUint(h.w), NO_RECORD);
#if HAS_INSTANCES
    hit.instance = hit_instances[slot];
#endif
    vec3 origin = ray_origins[slot].xyz, direction = ray_directions[slot].xyz;
    SurfacePoint p = locate(hit, origin, direction);
    meet_faces(origin, direction, path_states[slot].bodies, hit, p);
    hits[slot] = vec4(hit.t, hit.uv, uintBitsToFloat(hit.primitive));
#if HAS_INSTANCES
    hit_instances[slot] = hit.instance;
#endif
}
#else
layout(scalar, set = 0) readonly buffer Hits { vec4 hits[]; };
#endif

void main() {
    uint count = queue_counts[COUNTS_A_BOUNCE * bounce];
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x; first < count; first += stride) {
        uint i = first + gl_LocalInvocationID.x;
        uint slot = 0u, tag = NO_RECORD;
        if (i < count) {
            slot = ray_queue[read_queue + i];
#if HAS_PRIORITIES
            if (floatBitsToUint(hits[slot].w) != NO_RECORD) settle_hit(slot);
#endif
            uint primitive = floatBitsToUint(hits[slot].w);
            tag = 0u;
            if (primitive != NO_RECORD) tag = record_tag(materials[primitives[primitive].material].surface);
        }
        for (uint c = 0u; c < uint(SCATTER_CLASS_COUNT); ++c) {
            bool wanted = tag == SCATTER_CLASS_TAGS[c] || (c == 0u && tag == 0u);
            uvec4 ballot = subgroupBallot(wanted);
            uint place = 0u;
            if (subgroupElect()) place = atomicAdd(class_counts[bounce * SCATTER_CLASS_COUNT + c], subgroupBallotBitCount(ballot));
            place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(ballot);
            if (wanted) class_queues[c * slots + place] = slot;
        }
    }
}
