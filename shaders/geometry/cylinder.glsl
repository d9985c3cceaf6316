// The open side of a cylinder around the z axis, centred at the origin, seen from outside. u runs around,
// v from the lower to the upper rim.
//
// Example:
//     {"nodes": [{"name": "cylinder", "translation": [0, 0.4, 0], "rotation": [0.70711, 0, 0, -0.70711], "extensions": {"ETD_optics": {
//         "geometry": {"class": "cylinder", "radius": 0.3, "height": 0.8, "material": 1}}}}]}
#include "lib/accurate_math.glsl"
#include "lib/warps.glsl"

struct Cylinder {
    float radius;  //: required in (0, inf) m. Radius.
    float height;  //: required in (0, inf) m. Height, from -height/2 to height/2 along z.
};

// In the xy plane as for the sphere (Haines et al. 2019); of the two roots the first that lies between the rims.
bool cylinder_intersect(Cylinder r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(0));
    vec2 o = origin.xy, d = direction.xy;
    float a = dot(d, d);
    if (!(a > 0.0)) return false;
    float b = -dot(o, d);
    // The distance of the ray's line from the axis.
    float nearest = abs(o.x * d.y - o.y * d.x) / sqrt(a);
    float discriminant = (r.radius - nearest) * (r.radius + nearest);
    if (!(discriminant >= 0.0)) return false;
    float root = sqrt(a * discriminant);
    float q = b >= 0.0 ? b + root : b - root;
    float distance = length(o);
    float t0 = q != 0.0 ? (distance - r.radius) * (distance + r.radius) / q : 0.0;
    float t1 = q / a;
    float near = min(t0, t1), far = max(t0, t1);
    float half_height = 0.5 * r.height;
    bool near_met = near > 0.0 && near < t_max && abs(origin.z + near * direction.z) <= half_height;
    bool far_met = far > 0.0 && far < t_max && abs(origin.z + far * direction.z) <= half_height;
    hit.t = near_met ? near : far;
    return near_met || far_met;
}

LocalPoint cylinder_locate(Cylinder r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec3 p = origin + hit.t * direction;
    vec2 n = p.xy / length(p.xy);
    p.xy = r.radius * n;
    float turn = accurate_atan2(n.y, n.x) * (0.5 * INV_PI);
    return LocalPoint(p, vec3(gamma(5.0) * abs(p.xy), 0.0), vec3(n, 0.0), vec3(-n.y, n.x, 0.0),
                      vec2(turn < 0.0 ? turn + 1.0 : turn, p.z / r.height + 0.5));
}

float cylinder_area(Cylinder r) { return 2.0 * PI * r.radius * r.height; }

GeometrySample cylinder_sample(Cylinder r, vec2 u) {
    vec2 n = cos_sin_turns(u.x);
    return GeometrySample(vec3(r.radius * n, (u.y - 0.5) * r.height), vec3(n, 0.0), 1.0 / cylinder_area(r));
}

GeometrySample cylinder_sample_towards(Cylinder r, vec3 reference, vec2 u) { return cylinder_sample(r, u); }

float cylinder_pdf_towards(Cylinder r, vec3 reference, vec3 position, vec3 normal) { return 1.0 / cylinder_area(r); }

void cylinder_bounds(Cylinder r, out vec3 lo, out vec3 hi) {
    hi = vec3(r.radius, r.radius, 0.5 * r.height);
    lo = -hi;
}
