// Orders the vertices of large buckets by their keys, a workgroup to a bucket: a bitonic sorting network (Batcher 1968) in
// the form whose comparisons all point the same way, so that places behind the end need no padding.
// Reads: large_buckets, bucket_starts. Reads and writes: grid_items. Writes: grid_entries. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
#include "lib/vertex_grid.glsl"

layout(scalar, set = 0) coherent buffer GridItems { GridItem grid_items[]; };
layout(scalar, set = 0) readonly buffer LargeBuckets { uint large_buckets[]; };

void order_pair(uint first, uint a, uint b, uint count) {
    if (b >= count) return;
    if (grid_items[first + a].key <= grid_items[first + b].key) return;
    GridItem low = grid_items[first + b];
    grid_items[first + b] = grid_items[first + a];
    grid_items[first + a] = low;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    for (uint bucket = gl_WorkGroupID.x; bucket < large_bucket_count; bucket += gl_NumWorkGroups.x) {
        uint first = bucket_starts[large_buckets[bucket]];
        uint count = bucket_starts[large_buckets[bucket] + 1u] - first;
        uint places = 2u << findMSB(count - 1u);  // the next power of two
        for (uint size = 2u; size <= places; size *= 2u) {
            for (uint distance = size / 2u; distance > 0u; distance /= 2u) {
                for (uint pair = lane; pair < places / 2u; pair += gl_WorkGroupSize.x) {
                    uint low = pair & (distance - 1u), start = 2u * (pair - low);
                    uint high = distance == size / 2u ? size - 1u - low : low + distance;
                    order_pair(first, start + low, start + high, count);
                }
                memoryBarrierBuffer();
                barrier();
            }
        }
        for (uint i = first + lane; i < first + count; i += gl_WorkGroupSize.x)
            grid_entries[i] = vec4(grid_items[i].position, uintBitsToFloat(grid_items[i].vertex));
    }
}
