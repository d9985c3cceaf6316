// The film: for every pixel the sum of its samples, the rounding error of that sum (Neumaier 1974: what each addition
// loses is kept and added at the end), and what host/render/film_error.h tells the error from: the sum of squares, and
// sums over the even passes less those over the odd ones, which are independent of each other (lib/sampler.glsl).
#include "features/spectrum.glsl"
#include "features/defaults.glsl"
#include "features/stokes_images.glsl"
#include "lib/member_if.glsl"

struct FilmPixel {
    vec3 sum;
    uint samples;
    vec3 compensation;
    vec3 difference;           // even less odd passes
    vec3 squares;
    float squares_difference;  // of all channels together, even less odd passes
    MEMBER_IF(MERGE_VERTICES, vec3 bias;)  // features/bias.glsl
    MEMBER_IF(MERGE_VERTICES, vec3 bias_difference;)
};
layout(scalar, set = 0) buffer Film { FilmPixel film[]; };  // the layers of a pixel (features/stokes_images.glsl) side by side

void add_compensated(inout vec3 sum, inout vec3 compensation, vec3 value) {
    precise vec3 total = sum + value;
    precise vec3 larger_sum = (sum - total) + value;
    precise vec3 larger_value = (value - total) + sum;
    compensation += mix(larger_value, larger_sum, greaterThanEqual(abs(sum), abs(value)));
    sum = total;
}

float pass_sign(FilmPixel pixel) { return (pixel.samples & 1u) == 0u ? 1.0 : -1.0; }

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
