// What merging is off by, as its own vertices tell it (stages/merge_vertices.glsl): collected along a path, summed in the film.
#include "lib/path.glsl"
#include "lib/samples.glsl"

#if MERGE_VERTICES && !FORWARD
void start_bias(inout Path path) { path.bias = nothing_collected(); }

// The bias d is the difference of the density estimates that merging makes of the same light vertices with radius r and with
// r / sqrt(2). A box kernel's bias is c r² + O(r⁴), so d has the mean c r² / 2: half the bias of the pass (Richardson 1911,
// deferred approach to the limit).
Sample make_sample(vec3 value, Path path, uint layer) {
    vec3 d = spectrum_rgb(film_layer(path.bias, layer));
    return Sample(value, is_finite(d) ? d : vec3(0));
}
#else
#define start_bias(path)
#define make_sample(value, path, layer) Sample(value)
#endif
