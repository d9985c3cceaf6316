// What merging is off by, as its own vertices tell it (stages/merge_vertices.glsl): collected along a path, summed in the film.
#include "lib/film.glsl"
#include "lib/path.glsl"

#if MERGE_VERTICES && !FORWARD
void start_bias(inout Path path) { path.bias = Received(0); }

// Of the pass whose sample is added next: d is the difference of the density estimates that merging makes of the same
// light vertices with radius r and with r / sqrt(2). A box kernel's bias is c r² + O(r⁴), so d has the mean c r² / 2: half
// the bias of the pass (Richardson 1911, deferred approach to the limit).
void add_bias(inout FilmPixel pixel, vec3 d) {
    pixel.bias += d;
    pixel.bias_difference += pass_sign(pixel) * d;
}

void record_bias(inout FilmPixel pixel, Path path, uint layer) {
    vec3 bias = spectrum_rgb(layer_of(path.bias, layer));
    if (is_finite(bias)) add_bias(pixel, bias);
}
#else
#define start_bias(path)
#define record_bias(pixel, path, layer)
#endif
