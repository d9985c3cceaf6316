// Makes samples of the finished paths of each pixel of the tile.
// Reads: paths, splats. Writes: samples, splats, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint first_pixel, tile_pixels;
    uint pixels;         // of the image
    uint sample_passes;  // that there is room for
    uint first_sample, samples_at_once;  // passes
};
#include "lib/wavefront.glsl"
#include "stages/record_sample.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    Counters counters = no_counters();
    if (i < tile_pixels) {
        for (uint s = 0u; s < samples_at_once; ++s) {
            begin_pass(s);
            uint place = sample_place(first_pixel + i, pixels, first_sample + s, sample_passes);
            record_sample(place, first_pixel + i, path_states[s * tile_pixels + i], counters);
        }
    }
    if (subgroupAny(counters.non_finite != 0u)) store_counters(counters);
}
