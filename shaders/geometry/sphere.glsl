// A sphere centred at the origin, seen from outside. Poles on the z axis; u runs around it, v from +z to -z.
//
// Example:
//     {"nodes": [{"name": "sphere", "translation": [0, 0.45, 0], "extensions": {"ETD_optics": {
//         "geometry": {"class": "sphere", "radius": 0.45, "material": 1}}}}]}
#include "lib/accurate_math.glsl"
#include "lib/frames.glsl"

struct Sphere {
    float radius;  //: required in (0, inf) m. Radius.
};

// Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems ch. 7: the discriminant
// from the ray's nearest point to the centre, the roots without cancellation.
bool sphere_intersect(Sphere r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(0));
    float a = dot(direction, direction);
    float b = -dot(origin, direction);
    float nearest = length(origin + (b / a) * direction);
    float discriminant = (r.radius - nearest) * (r.radius + nearest);
    if (!(discriminant >= 0.0)) return false;
    float root = sqrt(a * discriminant);
    float q = b >= 0.0 ? b + root : b - root;
    float distance = length(origin);
    float c = (distance - r.radius) * (distance + r.radius);
    float t0 = q != 0.0 ? c / q : 0.0;
    float t1 = q / a;
    float near = min(t0, t1), far = max(t0, t1);
    float t = near > 0.0 ? near : far;
    if (!(t > 0.0 && t < t_max)) return false;
    hit.t = t;
    return true;
}

LocalPoint sphere_locate(Sphere r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec3 p = origin + hit.t * direction;
    vec3 n = p / length(p);
    p = r.radius * n;
    bool pole = p.x == 0.0 && p.y == 0.0;
    float turn = accurate_atan2(p.y, p.x) * (0.5 * INV_PI);
    vec2 uv = vec2(turn < 0.0 ? turn + 1.0 : turn, accurate_acos(n.z) * INV_PI);
    return LocalPoint(p, gamma(5.0) * abs(p), n, pole ? vec3(1, 0, 0) : vec3(-p.y, p.x, 0.0), uv);
}

float sphere_area(Sphere r) { return 4.0 * PI * r.radius * r.radius; }

GeometrySample sphere_sample(Sphere r, vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    vec3 n = vec3(sqrt(4.0 * u.x * (1.0 - u.x)) * cos_sin_turns(u.y), z);
    return GeometrySample(r.radius * n, n, 1.0 / sphere_area(r));
}

// 1 - cos of the half angle that the sphere fills as seen from a point outside, without cancellation.
float sphere_cone(Sphere r, float distance, out float cos_max) {
    float s = r.radius / distance;
    cos_max = sqrt((distance - r.radius) * (distance + r.radius)) / distance;
    return s * s / (1.0 + cos_max);
}

// From outside uniform over the cone that the sphere fills, from inside uniform over the sphere.
float sphere_pdf_towards(Sphere r, vec3 reference, vec3 position, vec3 normal) {
    float distance = length(reference);
    if (distance <= r.radius) return 1.0 / sphere_area(r);
    vec3 d = reference - position;
    float l = length(d);
    float cos_max;
    float solid_angle = 2.0 * PI * sphere_cone(r, distance, cos_max);
    return max(dot(d, normal), 0.0) / (l * l * l * solid_angle);
}

GeometrySample sphere_sample_towards(Sphere r, vec3 reference, vec2 u) {
    float distance = length(reference);
    if (distance <= r.radius) return sphere_sample(r, u);
    float cos_max;
    float lowest = u.x * sphere_cone(r, distance, cos_max);  // 1 - cos of the direction's angle to the axis
    float cos_axis = 1.0 - lowest;
    float sin_axis = sqrt(lowest * (2.0 - lowest));
    // Angle between the normal of the point met and the way back, by the law of sines.
    float sin_normal2 = min(u.x * (2.0 - lowest) / (1.0 + cos_max), 1.0);
    float sin_normal = sqrt(sin_normal2), cos_normal = sqrt(1.0 - sin_normal2);
    // Their difference is the angle at the centre.
    float cos_center = cos_normal * cos_axis + sin_normal * sin_axis;
    float sin_center = sin_normal * cos_axis - cos_normal * sin_axis;
    vec2 phi = cos_sin_turns(u.y);
    vec3 n = normalize(frame_around(reference / distance) * vec3(sin_center * phi, cos_center));
    vec3 p = r.radius * n;
    return GeometrySample(p, n, sphere_pdf_towards(r, reference, p, n));
}

void sphere_bounds(Sphere r, out vec3 lo, out vec3 hi) { lo = vec3(-r.radius), hi = vec3(r.radius); }
