// The film: for every pixel and layer (features/film_layers.glsl) what its samples add up to, in sums that do not depend on
// the order of the passes. Even and odd passes, which are independent of each other (lib/sampler.glsl), stand apart: from what
// they differ by, and from the sums of squares, host/render/film_error.h tells the error.
#include "features/film_layers.glsl"
#include "lib/exact_sum.glsl"
#include "lib/member_if.glsl"

struct FilmHalf {
    ExactSum sum;
    ExactSum squares;
    MEMBER_IF(MERGE_VERTICES, ExactSum bias;)  // features/bias.glsl
};
layout(scalar, set = 0) buffer Film { FilmHalf film[]; };  // of the even passes and of the odd ones, side by side

uint film_place(uint pixel, uint layer, uint pass) { return 2u * (FILM_LAYERS * pixel + layer) + (pass & 1u); }
