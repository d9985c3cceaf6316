// Puts the light vertices that merge in the order of their buckets.
// Reads: light vertices, grid_places, bucket_starts. Writes: grid_items. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
#include "lib/vertex_grid.glsl"

layout(scalar, set = 0) writeonly buffer GridItems { GridItem grid_items[]; };

void main() {
    uint count = stored_light_vertices();
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
        if ((light_vertices[i].previous & LIGHT_VERTEX_MERGES) == 0u) continue;
        GridPlace place = grid_places[i];
        grid_items[bucket_starts[place.bucket] + place.rank] = GridItem(light_vertices[i].position, i, place.key, place.bucket);
    }
}
