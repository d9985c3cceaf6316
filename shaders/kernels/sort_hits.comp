// Deals the paths of a bounce to one queue for each class of surface that they have hit; what has hit nothing goes to the
// first. Order within a queue does not matter: paths are independent. Where faces coincide, the hit becomes that of the one seen.
// Reads: the ray queue of this bounce, hits, paths, materials. Writes: class queues and their counts, hits. Barrier expected: after
// the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint bounce, read_queue, slots; };
#include "features/faces.glsl"
#include "lib/bvh.glsl"
#include "lib/materials.glsl"
#include "lib/wavefront.glsl"

// Where faces coincide: what is seen there.
void settle_hit(uint slot) {
    Hit hit = hits[slot];
    Path path = path_states[slot];
    SurfacePoint p = locate(hit, path.origin, path.direction);
    meet_faces(path.origin, path.direction, path.around, hit, p);
    hits[slot] = hit;
}

void main() {
    uint count = queue_counts[COUNTS_A_BOUNCE * bounce];
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x; first < count; first += stride) {
        uint i = first + gl_LocalInvocationID.x;
        uint slot = 0u, tag = NO_RECORD;
        if (i < count) {
            slot = ray_queue[read_queue + i];
            tag = 0u;
            if (hits[slot].primitive != NO_RECORD) {
                if (HAS_PRIORITIES == 1) settle_hit(slot);
                tag = record_tag(materials[primitives[hits[slot].primitive].material].surface);
                if (watching_view(path_states[slot], hits[slot]) != NO_RECORD) tag = record_tag(materials[RECEPTOR_MATERIAL].surface);
            } else if (goes_to_receptor(path_states[slot])) {
                tag = record_tag(materials[RECEPTOR_MATERIAL].surface);
            }
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
