// The film: for every pixel the sum of its samples, the rounding error of that sum (Neumaier 1974: what each addition
// loses is kept and added at the end), and the sum of squares for the standard error.
#include "lib/spectrum.glsl"

struct FilmPixel {
    vec3 sum;
    float samples;
    vec3 compensation;
    float reserved;
    vec3 squares;
    float reserved_squares;
};
// film_at(i): through the film's address where it is larger than a binding (lib/large_arrays.glsl).
#if FILM_BY_ADDRESS
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FilmAt { FilmPixel entries[]; };
layout(scalar, set = 0) readonly buffer FilmAddress { uvec2 film_address; };
#define film_at(i) FilmAt(film_address).entries[i]
#else
layout(scalar, set = 0) buffer Film { FilmPixel film[]; };
#define film_at(i) film[i]
#endif

void add_compensated(inout vec3 sum, inout vec3 compensation, vec3 value) {
    precise vec3 total = sum + value;
    precise vec3 larger_sum = (sum - total) + value;
    precise vec3 larger_value = (value - total) + sum;
    compensation += mix(larger_value, larger_sum, greaterThanEqual(abs(sum), abs(value)));
    sum = total;
}

void add_sample(inout FilmPixel pixel, vec3 value) {
    add_compensated(pixel.sum, pixel.compensation, value);
    pixel.squares += value * value;
    pixel.samples += 1.0;
}

bool is_finite(vec3 v) { return all(lessThan(abs(v), vec3(3e38))); }  // false for NaN, too
