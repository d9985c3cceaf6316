// Adds the finished samples of each pixel of the tile to the film, in the order of their index.
// Reads: path states. Writes: film, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint first_pixel, tile_pixels, samples; };
#include "lib/counters.glsl"
#include "lib/film.glsl"
#include "lib/wavefront.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    Counters counters = no_counters();
    if (i < tile_pixels) {
        FilmPixel pixel = film_at(first_pixel + i);
        for (uint s = 0u; s < samples; ++s) {
            Spectrum radiance = path_states[s * tile_pixels + i].radiance;
            bool finite = is_finite(radiance);
            counters.non_finite += finite ? 0u : 1u;
            add_sample(pixel, finite ? radiance : Spectrum(0));
        }
        film_at(first_pixel + i) = pixel;
    }
    store_counters(counters);
}
