// Floats with what they lack: sums and products without rounding, whatever the driver makes of fma (T. J. Dekker 1971, "A
// floating-point technique for extending the available precision"; D. E. Knuth, The Art of Computer Programming 2, 4.2.2).

// a + b = result + low
vec3 exact_sum_of(vec3 a, vec3 b, out vec3 low) {
    precise vec3 sum = a + b;
    precise vec3 part = sum - a;
    precise vec3 error = (a - (sum - part)) + (b - part);
    low = error;
    return sum;
}

// The upper half of the digits.
vec3 upper_digits(vec3 a) {
    precise vec3 c = 4097.0 * a;
    precise vec3 upper = c - (c - a);
    return upper;
}

// a b = result + low
vec3 exact_product_of(vec3 a, vec3 b, out vec3 low) {
    precise vec3 product = a * b;
    vec3 a1 = upper_digits(a), b1 = upper_digits(b);
    precise vec3 a2 = a - a1;
    precise vec3 b2 = b - b1;
    precise vec3 error = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
    low = error;
    return product;
}

// origin + t direction - (from + from_low), rounded once at the end.
vec3 place_from(vec3 origin, vec3 direction, float t, vec3 from, vec3 from_low) {
    vec3 way_low, start_low, low;
    vec3 way = exact_product_of(direction, vec3(t), way_low);
    vec3 start = exact_sum_of(origin, -from, start_low);
    vec3 place = exact_sum_of(start, way, low);
    precise vec3 result = place + ((start_low + low) + (way_low - from_low));
    return result;
}
