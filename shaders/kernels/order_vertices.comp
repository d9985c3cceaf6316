// Orders the vertices of each bucket by their keys: every vertex counts those that come before it. Buckets of more than
// LARGE_BUCKET are listed for order_large_buckets instead.
// Reads: grid_items, bucket_starts. Writes: grid_entries, large_buckets. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
#include "lib/vertex_grid.glsl"

layout(scalar, set = 0) readonly buffer GridItems { GridItem grid_items[]; };
layout(scalar, set = 0) writeonly buffer LargeBuckets { uint large_buckets[]; };

void main() {
    uint count = bucket_starts[bucket_mask + 1u];
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
        GridItem item = grid_items[i];
        uint first = bucket_starts[item.bucket], end = bucket_starts[item.bucket + 1u];
        if (end - first > LARGE_BUCKET) {
            if (i == first) large_buckets[atomicAdd(large_bucket_count, 1u)] = item.bucket;
            continue;
        }
        uint place = first;
        for (uint j = first; j < end; ++j) {
            uint key = grid_items[j].key;
            place += key < item.key || (key == item.key && j < i) ? 1u : 0u;
        }
        grid_entries[place] = vec4(item.position, uintBitsToFloat(item.vertex));
    }
}
