// A disk in the xy plane around the origin, facing +z, or a ring. u runs around, v from the centre to the rim.
//
// Example:
//     {"nodes": [{"name": "disk", "translation": [0, 0.45, 0], "rotation": [-0.2588, 0, 0, 0.9659], "extensions": {"ETD_optics": {
//         "geometry": {"class": "disk", "radius": 0.45, "material": 1}}}}]}
#include "lib/accurate_math.glsl"
#include "lib/warps.glsl"

struct Disk {
    float radius;  //: required in (0, inf) m. Radius.
    float hole;    //: 0 in [0, inf) m. Radius of a hole in its middle, less than that.
};

bool disk_intersect(Disk r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    float t = direction.z != 0.0 ? -origin.z / direction.z : 0.0;
    vec2 p = origin.xy + t * direction.xy;
    hit = GeometryHit(t, p);
    return t > 0.0 && t < t_max && length(p) <= r.radius && length(p) >= r.hole;
}

LocalPoint disk_locate(Disk r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec2 p = hit.uv;
    float turn = accurate_atan2(p.y, p.x) * (0.5 * INV_PI);
    vec3 tangent = dot(p, p) > 0.0 ? vec3(-p.y, p.x, 0.0) : vec3(1, 0, 0);
    // On the plane exactly.
    return LocalPoint(vec3(p, 0.0), vec3(0), vec3(0, 0, 1), tangent,
                      vec2(turn < 0.0 ? turn + 1.0 : turn, length(p) / r.radius));
}

float disk_area(Disk r) { return PI * (r.radius - r.hole) * (r.radius + r.hole); }

GeometrySample disk_sample(Disk r, vec2 u) {
    vec2 p = r.radius * warp_disk(u);
    float inner = r.hole / r.radius, distance = length(p);
    // Of a ring: as far out as leaves the parts of the area even.
    if (r.hole > 0.0) p = distance > 0.0 ? p * sqrt(square(r.hole / distance) + 1.0 - square(inner)) : vec2(r.hole, 0.0);
    return GeometrySample(vec3(p, 0.0), vec3(0, 0, 1), 1.0 / disk_area(r));
}

GeometrySample disk_sample_towards(Disk r, vec3 reference, vec2 u) { return disk_sample(r, u); }

float disk_pdf_towards(Disk r, vec3 reference, vec3 position, vec3 normal) { return 1.0 / disk_area(r); }

void disk_bounds(Disk r, out vec3 lo, out vec3 hi) {
    lo = vec3(-r.radius, -r.radius, 0.0), hi = vec3(r.radius, r.radius, 0.0);
}
