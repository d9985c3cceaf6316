// Warps of uniform points on [0,1)² to the distributions that samplers need. Sines are not the driver's, which may be off by
// 2^-11: points at the rim of the disk would lie beyond it, and directions at the horizon below.
#include "lib/accurate_math.glsl"
#include "lib/constants.glsl"

// Concentric map of Shirley & Chiu 1997: uniform on the unit disk.
vec2 warp_disk(vec2 u) {
    vec2 o = 2.0 * u - 1.0;
    bool wide = abs(o.x) > abs(o.y);
    float r = wide ? o.x : o.y;
    float s = wide ? o.y : o.x;
    if (r == 0.0) return vec2(0.0);
    vec2 p = cos_sin_small((PI / 4.0) * (s / r));
    return r * (wide ? p : p.yx);
}

// Cosine-weighted on the hemisphere z > 0; pdf = z / pi.
vec3 warp_cosine_hemisphere(vec2 u) {
    vec2 d = warp_disk(u);
    return vec3(d, sqrt(max(0.0, 1.0 - dot(d, d))));
}

// Uniform on the unit sphere; pdf = 1 / (4 pi).
vec3 warp_sphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float r = sqrt(max(0.0, 1.0 - z * z));
    return vec3(r * cos_sin_turns(u.y), z);
}

// Uniform barycentrics (b1, b2) on a triangle (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
vec2 warp_triangle(vec2 u) {
    return u.x < u.y ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

// … and back.
vec2 unwarp_triangle(vec2 b) { return b.x < b.y ? vec2(2.0 * b.x, b.x + b.y) : vec2(b.x + b.y, 2.0 * b.y); }

// x with density proportional to mix(a, b, x) on [0, 1].
float sample_linear(float a, float b, float u) {
    float scale = max(a, b);
    if (!(scale > 0.0)) return u;
    a /= scale, b /= scale;
    return min(u * (a + b) / (a + sqrt(mix(a * a, b * b, u))), 1.0);
}
