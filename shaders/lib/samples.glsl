// The samples of the last passes, pixel by pixel and layer by layer (features/film_layers.glsl), until they are added to the film.
#include "features/film_layers.glsl"
#include "lib/member_if.glsl"

struct Sample {
    vec3 value;
    MEMBER_IF(MERGE_VERTICES, vec3 bias;)  // features/bias.glsl
};
layout(scalar, set = 0) buffer Samples { Sample samples[]; };

// Of layer 0. `room`: passes that there is room for.
uint sample_place(uint pixel, uint pixels, uint pass, uint room) { return FILM_LAYERS * (pass % room * pixels + pixel); }

bool is_finite(vec3 v) { return all(lessThan(abs(v), vec3(3e38))); }  // false for NaN, too
