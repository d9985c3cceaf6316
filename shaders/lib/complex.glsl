// Complex numbers (real, imaginary).
vec2 complex_product(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }
vec2 conjugate(vec2 a) { return vec2(a.x, -a.y); }

vec2 complex_quotient(vec2 a, vec2 b) {
    return vec2(dot(a, b), a.y * b.x - a.x * b.y) / max(dot(b, b), 1e-30);
}

// With an imaginary part <= 0, for a with such: waves exp(i omega t) that fade away from the surface.
vec2 complex_root(vec2 a) {
    float l = length(a);
    return vec2(sqrt(max(0.5 * (l + a.x), 0.0)), -sqrt(max(0.5 * (l - a.x), 0.0)));
}
