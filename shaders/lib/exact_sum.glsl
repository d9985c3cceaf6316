// Sums whose bits do not depend on the order of the additions, so that passes may be added in any order and parts of a render
// merged in any way (after the binned summation of Demmel & Nguyen 2015, "Parallel Reproducible Summation", in integers).
//
// A float v is cut into digits of 24 bits: digit w is what v is in units of 2^(24 w), rounded, less what the digits above are.
// It is an integer of magnitude 2^23 at most, and zero where |v| is below half a unit. A sum keeps two digits, as integers of
// 64 bits: w of the largest value that it has met, and the one below. Which integers a value adds to digit w depends on the
// value alone. When a larger value comes, the upper digit becomes the lower one, which is what it would hold had w been as large
// from the beginning, since all values so far have nothing in the digits above. So what a sum holds after additions and mergers
// in any order is this: w of the largest value, and for both digits the sum of what all values have there.
//
// A value counts to within 2^-24 of the largest one, as if it had been rounded to the nearest float of that size; alike ones are
// added exactly. The three components share w. Values must be finite; what is below 2^-145 counts as zero. Twin:
// host/render/exact_sum.h.
struct ExactSum {
    uint window;        // w + 5: 0 to 10, so that zeroes are an empty sum
    uvec3 upper, lower;             // digits w and w - 1, two's complement, low words …
    uvec3 upper_high, lower_high;   // … and high words, which few additions reach
};

// The same of up to 255 values, in registers.
struct Digits {
    uint window;
    ivec3 upper, lower;
};
const uint MOST_ADDENDS = 255u;

Digits no_digits() { return Digits(0u, ivec3(0), ivec3(0)); }

void raise(inout Digits sum, uint window) {
    if (window <= sum.window) return;
    sum.lower = window == sum.window + 1u ? sum.upper : ivec3(0);
    sum.upper = ivec3(0);
    sum.window = window;
}

void add_exactly(inout Digits sum, vec3 value) {
    vec3 size = abs(value);
    uint exponent = floatBitsToUint(max(size.x, max(size.y, size.z))) >> 23;
    raise(sum, (max(exponent, 6u) - 6u) / 24u);  // biased by 127 = 6 + 1 + 5 * 24: below half a unit of the next window
    precise vec3 scaled = value * uintBitsToFloat((247u - 24u * sum.window) << 23);  // by 2^(-24 w)
    precise vec3 upper = roundEven(scaled);
    precise vec3 rest = (scaled - upper) * 16777216.0;
    sum.upper += ivec3(upper);
    sum.lower += ivec3(roundEven(rest));
}

uvec3 carry_of(uvec3 sum, ivec3 addend) { return uvec3(lessThan(sum, uvec3(addend))) - uvec3(lessThan(addend, ivec3(0))); }

// Adds `digits` to an ExactSum in memory; a macro, so that the words that stay as they are are not touched.
#define ADD_DIGITS(sum, digits)                                                             \
    {                                                                                       \
        uint window = sum.window;                                                           \
        if (digits.window > window) {                                                       \
            bool next = digits.window == window + 1u;                                       \
            sum.lower = next ? sum.upper : uvec3(0);                                        \
            sum.lower_high = next ? sum.upper_high : uvec3(0);                              \
            sum.upper = uvec3(0);                                                           \
            sum.upper_high = uvec3(0);                                                      \
            sum.window = digits.window;                                                     \
        }                                                                                   \
        raise(digits, window);                                                              \
        uvec3 upper = sum.upper + uvec3(digits.upper), lower = sum.lower + uvec3(digits.lower); \
        uvec3 upper_carry = carry_of(upper, digits.upper), lower_carry = carry_of(lower, digits.lower); \
        sum.upper = upper;                                                                  \
        sum.lower = lower;                                                                  \
        if (any(notEqual(upper_carry | lower_carry, uvec3(0)))) {                           \
            sum.upper_high += upper_carry;                                                  \
            sum.lower_high += lower_carry;                                                  \
        }                                                                                   \
    }

// To float precision, of what is no sum of cancelling values.
vec3 rounded(ExactSum sum) {
    vec3 upper = vec3(ivec3(sum.upper_high)) * 4294967296.0 + vec3(sum.upper);
    vec3 lower = vec3(ivec3(sum.lower_high)) * 4294967296.0 + vec3(sum.lower);
    return (upper + lower * (1.0 / 16777216.0)) * uintBitsToFloat((7u + 24u * sum.window) << 23);
}
