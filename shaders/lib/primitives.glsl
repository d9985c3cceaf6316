// Primitives in world space: the point a ray has hit, with its error bound, normals and vertex attributes; points on
// emissive primitives with their pdf.
#include "lib/bvh.glsl"
#include "lib/traversal.glsl"

struct SurfacePoint {
    vec3 position;
    vec3 error;             // bound of the distance from the exact surface, per axis, m
    vec3 geometric_normal;  // unit; the side that emits
    vec3 shading_normal;    // unit, on the side of the geometric normal
    vec4 tangent;           // along increasing u, not unit; w = handedness of the bitangent, ±1
    vec2 uv0, uv1;
    vec4 color;             // linear
    uint material;
    uint light;             // index into the list of lights, NO_RECORD where it does not emit
};

#include "features/vertex_attributes.glsl"

vec3 absolute_map(mat4x3 m, vec3 v, float w) {
    return abs(m[0]) * abs(v.x) + abs(m[1]) * abs(v.y) + abs(m[2]) * abs(v.z) + abs(m[3]) * w;
}

float transform_determinant(Transform m) {
    mat4x3 w = m.world_from_local;
    return dot(cross(w[0], w[1]), w[2]);
}

// From world to local the inverse transpose, up to length.
vec3 normal_to_world(Transform m, vec3 n) { return n * mat3(m.local_from_world); }
vec3 normal_to_local(Transform m, vec3 n) { return n * mat3(m.world_from_local); }

// World area per local area at a point with this normal (local, unit).
float area_factor(Transform m, vec3 n) { return abs(transform_determinant(m)) * length(normal_to_world(m, n)); }

// The error bound of a mapped point: its own mapped, what the map rounds (pbrt 4ed. 6.8.5), and what mapping back
// will round when a ray that starts there is intersected in the local frame again.
vec3 map_error(Transform m, vec3 local, vec3 local_error, vec3 world) {
    vec3 back = gamma(5.0) * absolute_map(m.local_from_world, world, 1.0);
    return absolute_map(m.world_from_local, (1.0 + gamma(5.0)) * local_error + back, 0.0) +
           gamma(5.0) * absolute_map(m.world_from_local, local, 1.0);
}

// A point in the frame of its shape or mesh, as it is in world space.
void place_point(inout SurfacePoint s, LocalPoint p, Transform to_world, inout vec3 shading) {
    s.position = to_world.world_from_local * vec4(p.position, 1.0);
    s.error = map_error(to_world, p.position, p.error, s.position);
    s.geometric_normal = normalize(normal_to_world(to_world, p.normal));
    shading = normal_to_world(to_world, shading);
    s.tangent.xyz = mat3(to_world.world_from_local) * s.tangent.xyz;
    s.tangent.w *= transform_determinant(to_world) < 0.0 ? -1.0 : 1.0;
}

// What the ray has hit. `hit.primitive` must not be NO_RECORD.
SurfacePoint locate(Hit hit, vec3 origin, vec3 direction) {
    Triangle r = primitives[hit.primitive];
    SurfacePoint s;
    s.material = r.material;
    s.light = r.light;
    s.color = vec4(1.0);
    LocalPoint p;
    vec3 shading = vec3(0);
    uint transform = NO_RECORD;
    if (is_shape(r.attributes)) {
        transform = floatBitsToUint(r.v0.y);
        mat4x3 m = transform_at(transform).local_from_world;
        p = geometry_locate(floatBitsToUint(r.v0.x), m * vec4(origin, 1.0), m * vec4(direction, 0.0), GeometryHit(hit.t, hit.uv));
        s.uv0 = s.uv1 = p.uv;
        s.tangent = vec4(p.tangent, 1.0);
    }
    if (is_triangle(r.attributes)) {
        p = triangle_locate(r, origin, direction, GeometryHit(hit.t, hit.uv));
        s.uv0 = s.uv1 = vec2(0);
        s.tangent = vec4(p.tangent, 1.0);
        if (!is_boundary(r.attributes)) interpolate_attributes(s, r, hit.uv, shading);
        if (HAS_INSTANCES == 1)
            if (hit.instance != NO_RECORD) transform = floatBitsToUint(primitives[hit.instance].v0.y);
    }
    s.position = p.position;
    s.error = p.error;
    s.geometric_normal = p.normal;
    if (!ONLY_TRIANGLES)
        if (transform != NO_RECORD) place_point(s, p, transform_at(transform), shading);
    float length2 = dot(shading, shading);
    s.shading_normal = length2 > 0.0 ? shading * inversesqrt(length2) : s.geometric_normal;
    if (dot(s.shading_normal, s.geometric_normal) < 0.0) s.shading_normal = -s.shading_normal;
    return s;
}

// The next float away from zero offset, in the direction of `towards`.
float next_float(float x, float towards) {
    if (towards == 0.0) return x;
    if (abs(x) < 1e-37) return towards > 0.0 ? 1e-37 : -1e-37;
    int bits = floatBitsToInt(x);
    return intBitsToFloat((x > 0.0) == (towards > 0.0) ? bits + 1 : bits - 1);
}

// Where a ray along `direction` leaves a surface: off it by the error bound, along the geometric normal, rounded
// away from it (pbrt 4ed. 6.8.6).
vec3 offset_origin(vec3 position, vec3 error, vec3 normal, vec3 direction) {
    vec3 offset = dot(abs(normal), error) * normal;
    if (dot(direction, normal) < 0.0) offset = -offset;
    vec3 p = position + offset;
    return vec3(next_float(p.x, offset.x), next_float(p.y, offset.y), next_float(p.z, offset.z));
}

// … and where a ray from `from` goes straight on there: never back. At an edge two surfaces may each place the ray before
// the other one, within their error bounds, and it would never get away.
vec3 origin_behind(vec3 from, vec3 position, vec3 error, vec3 normal, vec3 direction) {
    vec3 origin = offset_origin(position, error, normal, direction);
    if (dot(origin - from, direction) > 0.0) return origin;
    vec3 a = abs(from);
    return from + (max(dot(position - from, direction), 0.0) + 16.0 * EPSILON * max(a.x, max(a.y, a.z))) * direction;
}

// The end of a ray towards a sampled point of a light lies short of the light by the rounding error of both points, so
// that the light does not hide itself while anything a hair in front of it still does.
float shadow_t_max(vec3 origin, float distance) {
    vec3 a = abs(origin);
    return distance * (1.0 - 8.0 * EPSILON) - 32.0 * EPSILON * (max(a.x, max(a.y, a.z)) + distance);
}

// Emissive primitives: triangles in world space, or shapes. All pdfs are per world area, 1/m².

// Evenly by area, of a shape by that of its local frame. `error`: bound of the distance from the exact surface, per axis, m.
GeometrySample primitive_sample(uint primitive, vec2 u, out vec3 error) {
    Triangle r = primitives[primitive];
    GeometrySample s = GeometrySample(vec3(0), vec3(0, 0, 1), 0.0);
    error = vec3(0);
    if (is_shape(r.attributes)) {
        uint ref = floatBitsToUint(r.v0.x);
        Transform m = transform_at(floatBitsToUint(r.v0.y));
        GeometrySample local = geometry_sample(ref, u);
        vec3 lo, hi;
        geometry_bounds(ref, lo, hi);
        vec3 local_error = gamma(SAMPLE_ROUNDINGS) * max(abs(lo), abs(hi));
        s.pdf = local.pdf / area_factor(m, local.normal);
        s.position = m.world_from_local * vec4(local.position, 1.0);
        s.normal = normalize(normal_to_world(m, local.normal));
        error = map_error(m, local.position, local_error, s.position);
    }
    if (is_triangle(r.attributes)) {
        LocalPoint p = triangle_locate(r, vec3(0), vec3(0), GeometryHit(0.0, warp_triangle(u)));
        s = GeometrySample(p.position, p.normal, 1.0 / triangle_area(r));
        error = p.error;
    }
    return s;
}

// Of primitive_sample, at a point with this normal.
float primitive_pdf(uint primitive, vec3 normal) {
    Triangle r = primitives[primitive];
    float pdf = 0.0;
    if (is_shape(r.attributes)) {
        Transform m = transform_at(floatBitsToUint(r.v0.y));
        pdf = 1.0 / (geometry_area(floatBitsToUint(r.v0.x)) * area_factor(m, normalize(normal_to_local(m, normal))));
    }
    if (is_triangle(r.attributes)) pdf = 1.0 / triangle_area(r);
    return pdf;
}

GeometrySample primitive_sample_towards(uint primitive, vec3 reference, vec2 u) {
    Triangle r = primitives[primitive];
    GeometrySample s = GeometrySample(vec3(0), vec3(0, 0, 1), 0.0);
    if (is_shape(r.attributes)) {
        Transform m = transform_at(floatBitsToUint(r.v0.y));
        s = geometry_sample_towards(floatBitsToUint(r.v0.x), m.local_from_world * vec4(reference, 1.0), u);
        s.pdf /= area_factor(m, s.normal);
        s.position = m.world_from_local * vec4(s.position, 1.0);
        s.normal = normalize(normal_to_world(m, s.normal));
    }
    if (is_triangle(r.attributes)) s = triangle_sample_towards(r, reference, u);
    return s;
}

float primitive_pdf_towards(uint primitive, vec3 reference, vec3 position, vec3 normal) {
    Triangle r = primitives[primitive];
    float pdf = 0.0;
    if (is_shape(r.attributes)) {
        Transform m = transform_at(floatBitsToUint(r.v0.y));
        vec3 n = normalize(normal_to_local(m, normal));
        pdf = geometry_pdf_towards(floatBitsToUint(r.v0.x), m.local_from_world * vec4(reference, 1.0),
                                   m.local_from_world * vec4(position, 1.0), n) / area_factor(m, n);
    }
    if (is_triangle(r.attributes)) pdf = triangle_pdf_towards(r, reference, position, normal);
    return pdf;
}

// For a shape under a map that is no similarity the mean of the area factor over 8 x 8 points: no closed form.
float primitive_area(uint primitive) {
    Triangle r = primitives[primitive];
    float area = 0.0;
    if (is_shape(r.attributes)) {
        uint ref = floatBitsToUint(r.v0.x);
        Transform m = transform_at(floatBitsToUint(r.v0.y));
        for (uint i = 0u; i < 64u; i++) {
            vec2 u = (vec2(i & 7u, i >> 3) + 0.5) * 0.125;
            area += area_factor(m, geometry_sample(ref, u).normal);
        }
        area *= geometry_area(ref) / 64.0;
    }
    if (is_triangle(r.attributes)) area = triangle_area(r);
    return area;
}

void primitive_bounds(uint primitive, out vec3 lo, out vec3 hi) {
    Triangle r = primitives[primitive];
    lo = vec3(INFINITY), hi = vec3(-INFINITY);
    if (is_shape(r.attributes)) {
        mat4x3 m = transform_at(floatBitsToUint(r.v0.y)).world_from_local;
        vec3 local_lo, local_hi;
        geometry_bounds(floatBitsToUint(r.v0.x), local_lo, local_hi);
        vec3 center = 0.5 * (local_lo + local_hi), half_size = 0.5 * (local_hi - local_lo);
        vec3 world = m * vec4(center, 1.0);
        vec3 reach = absolute_map(m, half_size, 0.0) + gamma(8.0) * absolute_map(m, abs(center) + half_size, 1.0);
        lo = world - reach, hi = world + reach;
    }
    if (is_triangle(r.attributes)) triangle_bounds(r, lo, hi);
}

// Texture coordinates of a point on the primitive.
void primitive_uv(uint primitive, vec3 position, out vec2 uv0, out vec2 uv1) {
    uv0 = vec2(0), uv1 = vec2(0);
    Triangle r = primitives[primitive];
    if (is_shape(r.attributes)) {
        // A short ray through the point along each axis; the one that meets the surface nearest to it tells.
        uint ref = floatBitsToUint(r.v0.x);
        vec3 p = transform_at(floatBitsToUint(r.v0.y)).local_from_world * vec4(position, 1.0);
        vec3 lo, hi;
        geometry_bounds(ref, lo, hi);
        vec3 size = hi - lo;
        float reach = 1e-3 * max_component3(size);
        float best = INFINITY;
        for (uint axis = 0u; axis < 3u; axis++) {
            vec3 direction = vec3(axis == 0u, axis == 1u, axis == 2u) * reach;
            GeometryHit hit;
            if (geometry_intersect(ref, p - direction, direction, 2.0, hit) && abs(hit.t - 1.0) < best) {
                best = abs(hit.t - 1.0);
                uv0 = geometry_locate(ref, p - direction, direction, hit).uv;
            }
        }
        uv1 = uv0;
    }
    if (is_triangle(r.attributes)) triangle_uv(r, position, uv0, uv1);
}
