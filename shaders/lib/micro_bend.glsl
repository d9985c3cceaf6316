// Rays around a sheet of microstructure that is bent, as its axis sees them: that runs along y through (0, -bend), from which x is the
// way around the cylinder, and z away from it or, where the bend is negative, towards it.
#include "lib/accurate_math.glsl"
#include "lib/micro_shapes.glsl"
#include "lib/two_floats.glsl"

// A ray, from where it is nearest to the axis or starts.
struct MicroRound {
    float start;      // from where distances are, along the ray
    vec2 o, d;        // x and z
    float a, b;       // |d|², -o d
    float nearest;    // to the axis, m
    float way;        // that x runs, ±1
};
MicroRound micro_round(float bend, vec3 origin, vec3 direction) {
    MicroRound c;
    c.d = direction.xz;
    c.a = dot(c.d, c.d);
    c.start = c.a > 0.0 ? max(-dot(vec2(origin.x, origin.z + bend), c.d) / c.a, 0.0) : 0.0;
    c.o = place_from(origin, direction, c.start, vec3(0, 0, -bend), vec3(0)).xz;
    c.b = -dot(c.o, c.d);
    c.nearest = c.a > 0.0 ? length(c.o + c.b / c.a * c.d) : length(c.o);
    c.way = (c.o.y * c.d.x - c.o.x * c.d.y) * bend < 0.0 ? -1.0 : 1.0;
    return c;
}
// Where it enters and leaves a cylinder around the axis; none: both infinite.
vec2 micro_within(MicroRound c, float radius) {
    float distance = length(c.o);
    if (!(c.a > 0.0)) return distance < radius ? vec2(-INFINITY, INFINITY) : vec2(INFINITY);
    vec2 t = micro_roots(c.a, c.b, (distance - radius) * (distance + radius), c.a * (radius - c.nearest) * (radius + c.nearest));
    return t.x < INFINITY ? t + c.start : t;
}
// x on the sheet, between half the way around either way.
float micro_around(float bend, vec2 from_axis) {
    return bend * accurate_atan2(from_axis.x / bend, from_axis.y / bend);
}
