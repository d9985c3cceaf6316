// The bumps of a microstructure, in the frame of an element: its foot is around the origin in the plane z = 0, and it rises towards +z.
#include "lib/constants.glsl"

const uint MICRO_DOME = 0u;
const uint MICRO_CONE = 1u;
const uint MICRO_PRISM = 2u;
const uint MICRO_GROOVE = 3u;
const uint MICRO_LENS = 4u;

bool micro_runs_along(uint shape) { return shape == MICRO_GROOVE || shape == MICRO_LENS; }

// Is a point of the plane in the foot of the element? `q` in its axes.
bool micro_covers(uint shape, float radius, vec2 q) {
    if (micro_runs_along(shape)) return abs(q.x) < radius;
    if (shape == MICRO_PRISM) return max(abs(q.x), abs(q.y)) < radius;
    return dot(q, q) < radius * radius;
}

// Radius of the sphere or cylinder that the cap is cut from.
float micro_curvature_radius(float radius, float depth) { return (radius * radius + depth * depth) / (2.0 * depth); }

// a t² - 2 b t + c = 0 without cancellation (Goldberg 1991, section 1.4); none: both infinite.
vec2 micro_roots(float a, float b, float c, float discriminant) {
    if (!(discriminant >= 0.0)) return vec2(INFINITY);
    float root = sqrt(discriminant);
    float q = b >= 0.0 ? b + root : b - root;
    float t0 = q != 0.0 ? c / q : 0.0, t1 = a != 0.0 ? q / a : INFINITY;
    return vec2(min(t0, t1), max(t0, t1));
}

// Where a ray meets the shape, continued below its foot, which is convex there; in the element's axes, which a bump rises from.
vec2 micro_crossings(uint shape, float radius, float depth, vec3 o, vec3 d) {
    if (shape == MICRO_DOME || shape == MICRO_LENS) {
        // From the top, so that flat caps keep their digits.
        float curvature = micro_curvature_radius(radius, depth);
        o.z -= depth;
        if (shape == MICRO_LENS) o.y = d.y = 0.0;
        float a = dot(d, d), b = -(dot(o, d) + curvature * d.z), c = dot(o, o) + 2.0 * curvature * o.z;
        if (!(a > 0.0)) return vec2(INFINITY);
        float nearest = length(o + (b / a) * d + vec3(0, 0, curvature));
        return micro_roots(a, b, c, a * (curvature - nearest) * (curvature + nearest));
    }
    if (shape == MICRO_CONE) {
        float slope = radius / depth, w = depth - o.z;
        float a = dot(d.xy, d.xy) - slope * slope * d.z * d.z, b = -(dot(o.xy, d.xy) + slope * slope * w * d.z);
        float c = dot(o.xy, o.xy) - slope * slope * w * w;
        vec2 t = micro_roots(a, b, c, b * b - a * c);
        // Not on the other half of the double cone.
        if (o.z + t.x * d.z > depth) t.x = INFINITY;
        if (o.z + t.y * d.z > depth) t.y = INFINITY;
        return t;
    }
    // Faces |x| / radius + z / depth = 1.
    vec2 t = vec2(-INFINITY, INFINITY);
    uint faces = shape == MICRO_PRISM ? 4u : 2u;
    for (uint i = 0u; i < faces; ++i) {
        float side = (i & 1u) != 0u ? -1.0 : 1.0;
        vec3 n = vec3(i < 2u ? side : 0.0, i < 2u ? 0.0 : side, radius / depth);
        float towards = dot(n, d), height = radius - dot(n, o);
        if (towards == 0.0 && height < 0.0) return vec2(INFINITY);
        if (towards < 0.0) t.x = max(t.x, height / towards);
        if (towards > 0.0) t.y = min(t.y, height / towards);
    }
    if (t.x > t.y) return vec2(INFINITY);
    if (t.x == -INFINITY) t.x = INFINITY;
    return t;
}

// Outward normal of a bump above q, not unit, and its height there.
vec3 micro_normal(uint shape, float radius, float depth, vec2 q, out float z) {
    if (shape == MICRO_DOME || shape == MICRO_LENS) {
        if (shape == MICRO_LENS) q.y = 0.0;
        float curvature = micro_curvature_radius(radius, depth);
        float up = sqrt(max(curvature * curvature - dot(q, q), 0.0));
        z = up + (depth - curvature);
        return vec3(q, up);
    }
    vec2 away = shape == MICRO_CONE ? q : vec2(q.x, 0.0);
    if (shape == MICRO_PRISM && abs(q.y) > abs(q.x)) away = vec2(0.0, q.y);
    float distance = length(away);
    z = depth * (1.0 - distance / radius);
    return vec3(distance > 0.0 ? away / distance * depth : vec2(0), radius);
}

// Is a point within the shape, continued below its foot? In its axes.
bool micro_holds(uint shape, float radius, float depth, vec3 q) {
    if (shape == MICRO_DOME || shape == MICRO_LENS) {
        q.z -= depth;
        if (shape == MICRO_LENS) q.y = 0.0;
        return dot(q, q) + 2.0 * micro_curvature_radius(radius, depth) * q.z < 0.0;
    }
    return micro_covers(shape, radius * (1.0 - q.z / depth), q.xy) && q.z < depth;
}
