// The triangles of meshes. A record is at the same time an entry of the `primitives` buffer, which the
// hierarchy's leaves point into: entries of shapes and instances keep other things in the place of the vertices
// (lib/bvh.glsl). Vertices are in world space, or in the mesh's frame under an instance; counter-clockwise as seen
// from the side of the normal.
//
// Example:
//     {"nodes": [{"name": "triangle", "mesh": 0}],
//      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]}],
//      "accessors": [{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5126, "min": [-0.5, 0.02, -0.25], "max": [0.55, 0.95, 0.15]}],
//      "bufferViews": [{"buffer": 0, "byteLength": 36}],
//      "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAvwrXozyamRk+zcwMPwrXozzNzMw9zcxMPTMzcz8AAIC+"}]}

struct Triangle {
    vec3 v0;          // m
    uint material;    // index into the materials
    vec3 v1;
    uint light;       // index into the list of lights, NO_RECORD where it does not emit
    vec3 v2;
    uint attributes;  // kind:2 | index:30, see lib/bvh.glsl
};

// The shear that turns a ray into the axis z, after the axes are permuted so that z is the ray's longest
// (Woop, Benthin & Wald 2013, "Watertight Ray/Triangle Intersection").
struct RayShear {
    bool longest_x, longest_z;
    vec3 factors;  // d.x / d.z, d.y / d.z, 1 / d.z, permuted
};

vec3 permute_axes(RayShear s, vec3 v) {
    return vec3(s.longest_x ? v.y : v.x, s.longest_z ? v.y : v.z, s.longest_x ? v.x : s.longest_z ? v.z : v.y);
}

RayShear ray_shear(vec3 direction) {
    vec3 d = abs(direction);
    RayShear s;
    s.longest_x = d.x >= d.y && d.x >= d.z;
    s.longest_z = !s.longest_x && d.z >= d.y;
    vec3 p = permute_axes(s, direction);
    s.factors = vec3(p.xy, 1.0) / p.z;
    return s;
}

// A vertex relative to the ray's origin, sheared; z is left unscaled. Rounds alike for every triangle that shares it.
vec3 shear_vertex(RayShear s, vec3 v) {
    vec3 p = permute_axes(s, v);
    precise vec2 xy = p.xy - s.factors.xy * p.z;
    return vec3(xy, p.z);
}

// Nearest hit with 0 < t < t_max, uv = barycentrics of v1 and v2. A ray through a shared edge or vertex hits at
// least one of the triangles: rounding is monotone, so an edge function is never of the wrong sign, at worst zero,
// and zero counts as inside. The distance comes from the triangle's plane, whose rounding error shrinks with the
// ray's distance from an axis-aligned plane; an origin that lies on the plane within that error does not hit it.
bool triangle_meet(RayShear s, vec3 origin, vec3 direction, vec3 v0, vec3 v1, vec3 v2, float t_max,
                   inout GeometryHit hit) {
    precise vec3 o0 = v0 - origin;
    precise vec3 o1 = v1 - origin;
    precise vec3 o2 = v2 - origin;
    vec3 a = shear_vertex(s, o0);
    vec3 b = shear_vertex(s, o1);
    vec3 c = shear_vertex(s, o2);
    precise float u = c.x * b.y - c.y * b.x;
    precise float v = a.x * c.y - a.y * c.x;
    precise float w = b.x * a.y - b.y * a.x;
    precise float det = u + v + w;
    bool inside = (min(min(u, v), w) >= 0.0 || max(max(u, v), w) <= 0.0) && abs(det) > 0.0;
    if (!inside) return false;
    vec3 z = vec3(a.z, b.z, c.z) * s.factors.z;
    vec3 e1 = v1 - v0, e2 = v2 - v0;
    vec3 p = e1.yzx * e2.zxy, q = e1.zxy * e2.yzx;
    vec3 n = p - q;
    float height = dot(n, o0);
    float slope = dot(n, direction);
    float t = slope != 0.0 ? height / slope : z.x;
    t = clamp(t, min(min(z.x, z.y), z.z), max(max(z.x, z.y), z.z));
    // e1, e2, o0 are rounded once, products and sums of three add the rest.
    bool apart = abs(height) > gamma(8.0) * dot(abs(p) + abs(q), abs(o0));
    if (!(apart && t > 0.0 && t < t_max)) return false;
    hit = GeometryHit(t, vec2(v, w) / det);
    return true;
}

bool triangle_intersect(Triangle r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(0));
    return triangle_meet(ray_shear(direction), origin, direction, r.v0, r.v1, r.v2, t_max, hit);
}

// The height above a point of it from which rays surely hit it: four times what triangle_meet asks for. m
float triangle_clearance(Triangle r, vec3 point) {
    vec3 e1 = r.v1 - r.v0, e2 = r.v2 - r.v0;
    vec3 size = max(abs(e1), abs(e2));
    float scale = max(max(size.x, size.y), size.z);
    e1 /= scale, e2 /= scale;
    vec3 p = e1.yzx * e2.zxy, q = e1.zxy * e2.yzx;
    return 4.0 * gamma(8.0) * dot(abs(p) + abs(q), abs(r.v0 - point)) / max(length(p - q), 1e-30);
}

// Twice the area along the normal.
vec3 triangle_cross(Triangle r) { return cross(r.v1 - r.v0, r.v2 - r.v0); }

// Scaled before it is squared: micrometre triangles would underflow.
vec3 triangle_normal(Triangle r) {
    vec3 e1 = r.v1 - r.v0, e2 = r.v2 - r.v0;
    vec3 size = max(abs(e1), abs(e2));
    float scale = max(max(size.x, size.y), size.z);
    vec3 n = cross(e1 / scale, e2 / scale);
    float l = length(n);
    return l > 0.0 ? n / l : vec3(0, 0, 1);
}

// Barycentrics of a point kept off the edges by more than rounding. Nearer to an edge it could come to lie behind the
// neighbour that shares it, or so close to the neighbour's plane that a ray towards it counts as starting on it: light would
// leave a closed mesh there. Moves the point by less than the size of the triangle times 1e-5.
vec3 inner_barycentrics(Triangle r, vec2 uv) {
    vec3 e1 = r.v1 - r.v0, e2 = r.v2 - r.v0, e3 = r.v2 - r.v1;
    vec3 sizes = vec3(length(e1), length(e2), length(e3)), far = max(max(abs(r.v0), abs(r.v1)), abs(r.v2));
    float longest = max(max(sizes.x, sizes.y), sizes.z);
    float margin = 32.0 * EPSILON * longest + 16.0 * EPSILON * max(max(far.x, far.y), far.z);
    float lowest_height = length(cross(e1 / longest, e2 / longest)) * longest;
    float least = min(margin / max(lowest_height, 1e-30), 0.25);
    vec3 b = max(vec3(1.0 - uv.x - uv.y, uv), vec3(least));
    return b / (b.x + b.y + b.z);
}

LocalPoint triangle_locate(Triangle r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec3 b = inner_barycentrics(r, hit.uv);
    vec3 p0 = b.x * r.v0, p1 = b.y * r.v1, p2 = b.z * r.v2;
    // Error bound of pbrt 4ed. eq. 6.13.
    return LocalPoint(p0 + p1 + p2, gamma(7.0) * (abs(p0) + abs(p1) + abs(p2)), triangle_normal(r), r.v1 - r.v0,
                      hit.uv);
}

float triangle_area(Triangle r) { return 0.5 * length(triangle_cross(r)); }

GeometrySample triangle_sample(Triangle r, vec2 u) {
    vec2 b = warp_triangle(u);
    vec3 position = (1.0 - b.x - b.y) * r.v0 + b.x * r.v1 + b.y * r.v2;
    return GeometrySample(position, triangle_normal(r), 1.0 / triangle_area(r));
}

GeometrySample triangle_sample_towards(Triangle r, vec3 reference, vec2 u) { return triangle_sample(r, u); }

float triangle_pdf_towards(Triangle r, vec3 reference, vec3 position, vec3 normal) { return 1.0 / triangle_area(r); }

void triangle_bounds(Triangle r, out vec3 lo, out vec3 hi) {
    lo = min(min(r.v0, r.v1), r.v2);
    hi = max(max(r.v0, r.v1), r.v2);
}
