// Inverse trigonometric functions and sines good to a few units in the last place. A driver's own may be good
// to no more than 1e-4 (lavapipe's acos, SwiftShader's sin). Polynomials of Moshier's Cephes library, single
// precision.

#include "lib/constants.glsl"

// a, or about - a. Not `flips ? about - a : a`: time and memory that SwiftShader takes double with every choice between two
// expressions of one value.
float flip(float a, bool flips, float about) { return (flips ? -1.0 : 1.0) * a + (flips ? about : 0.0); }

// The angle of (x, y) from +x, in [-pi, pi], as atan(y, x); 0 at the origin. Relative error below 3e-7.
float accurate_atan2(float y, float x) {
    float big = max(abs(x), abs(y)), small = min(abs(x), abs(y));
    // Above tan(pi/8): atan(q) = pi/4 + atan((q - 1) / (q + 1)).
    bool upper = small > 0.414213562 * big;
    float numerator = upper ? small - big : small;
    float denominator = upper ? small + big : big;
    float q = denominator > 0.0 ? numerator / denominator : 0.0;
    float z = q * q;
    float a = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * q + q;
    a += upper ? 0.25 * PI : 0.0;
    a = flip(a, abs(y) > abs(x), 0.5 * PI);
    a = flip(a, x < 0.0, PI);
    return flip(a, y < 0.0, 0.0);
}

float accurate_asin_small(float x) {  // |x| <= 0.5
    float z = x * x;
    return ((((4.2163199048e-2 * z + 2.4181311049e-2) * z + 4.5470025998e-2) * z + 7.4953002686e-2) * z +
            1.6666752422e-1) * z * x + x;
}

// Relative error below 4e-7; the argument is clamped to [-1, 1].
float accurate_asin(float x) {
    float a = min(abs(x), 1.0);
    bool large = a > 0.5;
    float s = accurate_asin_small(large ? sqrt(0.5 * (1.0 - a)) : a);
    float r = large ? 0.5 * PI - 2.0 * s : s;
    return x < 0.0 ? -r : r;
}

float accurate_acos(float x) {
    float a = min(abs(x), 1.0);
    bool large = a > 0.5;
    float s = accurate_asin_small(large ? sqrt(0.5 * (1.0 - a)) : a);
    float r = large ? 2.0 * s : 0.5 * PI - s;  // of |x|
    return x < 0.0 ? PI - r : r;
}

// (cos, sin) of an angle of at most pi/4 either way; absolute error below 2e-7.
vec2 cos_sin_small(float a) {
    float z = a * a;
    return vec2(((2.443315711809948e-5 * z - 1.388731625493765e-3) * z + 4.166664568298827e-2) * z * z - 0.5 * z + 1.0,
                ((-1.9515295891e-4 * z + 8.3321608736e-3) * z - 1.6666654611e-1) * z * a + a);
}

// (cos, sin) of `turns` full turns, |turns| < 2^20; absolute error below 2e-7.
vec2 cos_sin_turns(float turns) {
    float quadrant = floor(4.0 * turns + 0.5);
    vec2 p = cos_sin_small((turns - 0.25 * quadrant) * (2.0 * PI));  // the difference is exact
    uint k = uint(int(quadrant)) & 3u;
    vec2 r = (k & 1u) != 0u ? p.yx : p;
    // Quadrants 1 and 2 have a negative cosine, 2 and 3 a negative sine.
    return vec2(k == 1u || k == 2u ? -r.x : r.x, k >= 2u ? -r.y : r.y);
}

// 1 - cos(angle), which keeps the digits of small angles. Radians.
float versine(float angle) { return 2.0 * square(cos_sin_turns(angle * (0.25 * INV_PI)).y); }
