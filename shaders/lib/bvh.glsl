// Layout of the hierarchies that the host builds (host/geometry/bvh.h), and the test of a node's two boxes.
//
// nodes[i] is an entry (uvec4) of the `nodes` buffer. A tree starts with a header of two entries:
//     lower corner of its grid (float bits), reference of the root | cells per metre, largest extent in m (float bits)
// then inner nodes, two entries each, one a child: bounds along x, y, z (low half: lower bound, high half: upper
// bound, in cells of the grid, rounded outward), reference of the child.
// A reference is the entry of an inner node, or a leaf: bit 31, count - 1 in bits 29 and 30, first primitive.
//
// primitives[i] is an entry of `primitives`, struct Triangle. Its attributes' upper two bits are the kind:
//     triangle   the vertices; index = its place in the mesh's lists of vertex indices
//     shape      v0.x RecordRef of the geometry, v0.y index of its transform (bits)
//     boundary   the vertices; index = the element that it leads to (features/elements.glsl)
//     instance   v0.x header of the mesh's own tree, v0.y index of its transform (bits)
#include "lib/constants.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"
#include "interfaces/geometry.glsl"
#include "geometry/triangle.glsl"


layout(scalar) readonly buffer Nodes { uvec4 nodes[]; };
layout(scalar) readonly buffer Primitives { Triangle primitives[]; };

const uint BVH_LEAF = 0x80000000u;
const uint BVH_FIRST_MASK = 0x1FFFFFFFu;
const uint BVH_COUNT_MASK = 0x60000000u;
const uint BVH_COUNT_ONE = 0x20000000u;
const uint BVH_NOTHING = 0xFFFFFFFEu;  // no reference: nothing left to visit
const uint BVH_RETURN = 0xFFFFFFFFu;   // on the stack: the instance is done, go on in world space

#include "features/primitive_kinds.glsl"
uint attributes_index(uint attributes) { return attributes & 0x3FFFFFFFu; }

// An affine map and its inverse, each rounded from doubles.
struct Transform {
    mat4x3 world_from_local;
    mat4x3 local_from_world;
};
layout(scalar) readonly buffer Transforms { Transform transforms[]; };
#define transform_at(i) transforms[i]

float max_component3(vec3 v) { return max(max(v.x, v.y), v.z); }
float min_component3(vec3 v) { return min(min(v.x, v.y), v.z); }

// A ray as boxes see it: in cells of the tree's grid, started where it enters the grid, `start` along the ray.
// The planes it meets first are tested from near_origin, those it leaves by from far_origin: they differ by a bound
// of all rounding, that of the primitives' tests included, so no box is missed whose primitive would be hit.
struct BoxRay {
    vec3 near_origin, far_origin, inverse;
    uvec3 near_shift;  // 16 where the ray runs down the axis: picks the upper bound as the first plane
    float start;
};

BoxRay box_ray(uint header, vec3 origin, vec3 direction) {
    uvec4 first = nodes[header], second = nodes[header + 1u];
    vec3 from_lo = origin - uintBitsToFloat(first.xyz);
    float extent = uintBitsToFloat(second.w);
    vec3 cells = uintBitsToFloat(second.xyz);
    vec3 o = from_lo * cells;
    vec3 d = direction * cells;
    d = mix(d, vec3(1e-25), lessThan(abs(d), vec3(1e-25)));  // finite inverse: 0 * infinity never comes up
    BoxRay ray;
    ray.inverse = 1.0 / d;
    vec3 enter = (mix(vec3(0.0), vec3(65536.0), lessThan(d, vec3(0.0))) - o) * ray.inverse;
    ray.start = clamp(max_component3(enter), 0.0, INFINITY);
    vec3 step = ray.start * d;
    float reach = max_component3(abs(from_lo) + abs(ray.start * direction)) + extent;
    vec3 margin = gamma(8.0) * reach * cells;
    margin = mix(margin, -margin, lessThan(d, vec3(0.0)));
    ray.near_origin = o + step + margin;
    ray.far_origin = o + step - margin;
    ray.near_shift = mix(uvec3(0u), uvec3(16u), lessThan(d, vec3(0.0)));
    return ray;
}

// The ends of the ray's way through the two boxes of node `i`, along the ray from `start`; a box is met where
// near <= far. The last factor widens the way by the rounding of three operations (Ize 2013).
void meet_boxes(BoxRay ray, uint i, float limit, out vec2 near, out vec2 far, out uvec2 child) {
    uvec4 e0 = nodes[i], e1 = nodes[i + 1u];
    uvec3 far_shift = 16u - ray.near_shift;
    vec3 n0 = (vec3((e0.xyz >> ray.near_shift) & 0xFFFFu) - ray.near_origin) * ray.inverse;
    vec3 f0 = (vec3((e0.xyz >> far_shift) & 0xFFFFu) - ray.far_origin) * ray.inverse;
    vec3 n1 = (vec3((e1.xyz >> ray.near_shift) & 0xFFFFu) - ray.near_origin) * ray.inverse;
    vec3 f1 = (vec3((e1.xyz >> far_shift) & 0xFFFFu) - ray.far_origin) * ray.inverse;
    const float widen = 1.0 + 8.0 * EPSILON;
    near = vec2(max(max(n0.x, n0.y), max(n0.z, 0.0)), max(max(n1.x, n1.y), max(n1.z, 0.0)));
    far = vec2(min(min_component3(f0) * widen, limit), min(min_component3(f1) * widen, limit));
    child = uvec2(e0.w, e1.w);
}
