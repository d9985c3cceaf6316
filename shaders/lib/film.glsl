// The film: for every pixel the sum of its samples, the rounding error of that sum (Neumaier 1974: what each addition
// loses is kept and added at the end), and what host/render/film_error.h tells the error from: the sum of squares, and
// sums over the even passes less those over the odd ones, which are independent of each other (lib/sampler.glsl).
#include "lib/spectrum.glsl"

#ifndef MERGE_VERTICES
#define MERGE_VERTICES 0
#endif

struct FilmPixel {
    vec3 sum;
    uint samples;
    vec3 compensation;
    vec3 difference;           // even less odd passes
    vec3 squares;
    float squares_difference;  // of all channels together, even less odd passes
#if MERGE_VERTICES
    vec3 bias;                 // add_bias
    vec3 bias_difference;
#endif
};
layout(scalar, set = 0) buffer Film { FilmPixel film[]; };

void add_compensated(inout vec3 sum, inout vec3 compensation, vec3 value) {
    precise vec3 total = sum + value;
    precise vec3 larger_sum = (sum - total) + value;
    precise vec3 larger_value = (value - total) + sum;
    compensation += mix(larger_value, larger_sum, greaterThanEqual(abs(sum), abs(value)));
    sum = total;
}

float pass_sign(FilmPixel pixel) { return (pixel.samples & 1u) == 0u ? 1.0 : -1.0; }

#if MERGE_VERTICES
// Of the pass whose sample is added next: d is the difference of the density estimates that merging makes of the same
// light vertices with radius r and with r / sqrt(2). A box kernel's bias is c r² + O(r⁴), so d has the mean c r² / 2: half
// the bias of the pass (Richardson 1911, deferred approach to the limit).
void add_bias(inout FilmPixel pixel, vec3 d) {
    pixel.bias += d;
    pixel.bias_difference += pass_sign(pixel) * d;
}
#endif

// The sample of the next pass, in order.
void add_sample(inout FilmPixel pixel, vec3 value) {
    float s = pass_sign(pixel);
    add_compensated(pixel.sum, pixel.compensation, value);
    pixel.difference += s * value;
    pixel.squares += value * value;
    pixel.squares_difference += s * dot(value, value);
    pixel.samples++;
}

bool is_finite(vec3 v) { return all(lessThan(abs(v), vec3(3e38))); }  // false for NaN, too
