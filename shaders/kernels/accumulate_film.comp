// Adds the samples of passes to the film, one lane a pixel.
// Reads: samples. Writes: film. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint pixels;
    uint sample_passes;        // that there is room for
    uint first_pass, passes;   // 2 MOST_ADDENDS at most
};
#include "features/film_addends.glsl"

void main() {
    uint lanes = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint i = gl_GlobalInvocationID.x; i < FILM_LAYERS * pixels; i += lanes) {
        uint pixel = i / FILM_LAYERS, layer = i % FILM_LAYERS;
        for (uint start = 0u; start < min(passes, 2u); ++start) {
            FilmAddends addends = no_addends();
            for (uint s = start; s < passes; s += 2u)
                add_sample(addends, samples[sample_place(pixel, pixels, first_pass + s, sample_passes) + layer]);
            add_to_film(film_place(pixel, layer, first_pass + start), addends);
        }
    }
}
