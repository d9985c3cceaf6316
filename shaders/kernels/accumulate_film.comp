// Adds the finished samples of each pixel of the tile to the film, in the order of their index. What forward rays have brought
// to a pixel in this pass counts as part of its sample.
// Reads: paths, splats. Writes: film, splats, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint first_pixel, tile_pixels, samples; };
#include "lib/wavefront.glsl"
#include "stages/record_sample.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    Counters counters = no_counters();
    if (i < tile_pixels) {
        FilmPixel pixel = film[FILM_LAYERS * (first_pixel + i)];
        for (uint s = 0u; s < samples; ++s) {
            begin_pass(s);
            record_sample(pixel, first_pixel + i, path_states[s * tile_pixels + i], counters);
        }
        film[FILM_LAYERS * (first_pixel + i)] = pixel;
    }
    store_counters(counters);
}
