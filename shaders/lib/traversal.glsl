// Rays through the scene's hierarchy: the nearest hit, or any.
//
// On a CPU driver the lanes of a subgroup walk their rays together, so a step of the walk does at most one inner
// node and at most one primitive for each lane, and pushes and pops by selects instead of branches.

#include "lib/bvh.glsl"

// Entries of the stack: the deepest way down (bvh_max_depth of host/geometry/bvh.h) and what marks its ends, twice with
// instances. The host may know that less is enough.
#ifndef BVH_STACK_SIZE
#if HAS_INSTANCES
#define BVH_STACK_SIZE 100
#else
#define BVH_STACK_SIZE 50
#endif
#endif

struct Hit {
    float t;         // along the ray, in lengths of its direction
    vec2 uv;         // of the primitive's class
    uint primitive;  // entry of `primitives`; NO_RECORD = nothing was hit
    uint instance;   // entry of `primitives` of the instance that holds it; NO_RECORD = none
};

#if HAS_PRIORITIES
// The order of a ray's hits: by distance, and by what is hit where distances are the same to the last bit.
bool comes_after(Hit a, Hit b) {
    if (a.t != b.t) return a.t > b.t;
    return a.instance > b.instance || (a.instance == b.instance && a.primitive > b.primitive);
}
// The end of a ray that has met `hit`: hits of the same distance are still of interest.
#define HIT_LIMIT(hit) (hit.primitive == NO_RECORD ? hit.t : uintBitsToFloat(floatBitsToUint(hit.t) + 1u))
#else
#define HIT_LIMIT(hit) hit.t
#endif

// Scenes of few primitives come as straight code (host/geometry/unrolled_traversal.h).
#if HAS_UNROLLED_TRAVERSAL
#include "generated/unrolled_traversal.glsl"
#else

struct Traversal {
    vec3 origin, direction;  // in the frame being walked
    RayShear shear;
    BoxRay box;
    float limit;   // end of the ray as boxes see it
    uint node;     // reference to visit next; BVH_NOTHING when done
    uint height;   // of the stack
    Hit hit;       // hit.t is t_max until something is hit
#if HAS_INSTANCES
    vec3 world_origin, world_direction;
    uint instance;
#endif
#if HAS_PRIORITIES
    Hit after;     // only hits after this one count
    float skipped; // its distance as boxes see it, at most
#endif
};

uint traversal_stack[BVH_STACK_SIZE];

const uint WORLD_HEADER = 0u;  // entry of `nodes` where the scene's own tree starts

void traversal_enter(inout Traversal w, uint header, vec3 origin, vec3 direction) {
    w.origin = origin;
    w.direction = direction;
    w.box = box_ray(header, origin, direction);
    w.limit = w.hit.t - w.box.start;
#if HAS_PRIORITIES
    w.skipped = w.after.t * (1.0 - 4.0 * EPSILON) - w.box.start;
#endif
    w.shear = ray_shear(direction);
}

void traversal_begin(out Traversal w, vec3 origin, vec3 direction, float t_max) {
    w.hit = Hit(t_max, vec2(0), NO_RECORD, NO_RECORD);
#if HAS_PRIORITIES
    w.after = Hit(0.0, vec2(0), NO_RECORD, NO_RECORD);
#endif
    traversal_enter(w, WORLD_HEADER, origin, direction);
    w.node = nodes[WORLD_HEADER].w;
    traversal_stack[0] = BVH_NOTHING;
    w.height = 1u;
#if HAS_INSTANCES
    w.world_origin = origin;
    w.world_direction = direction;
    w.instance = NO_RECORD;
#endif
}

void traversal_step(inout Traversal w, const bool any_hit) {
    if (w.node < BVH_LEAF) {
        vec2 near, far;
        uvec2 child;
        meet_boxes(w.box, w.node, w.limit, near, far, child);
        bool first = near.x <= far.x, second = near.y <= far.y;
#if HAS_PRIORITIES
        first = first && far.x >= w.skipped, second = second && far.y >= w.skipped;
#endif
        bool both = first && second;
        bool second_nearer = second && (!first || near.y < near.x);
        uint popped = traversal_stack[w.height - 1u];
        traversal_stack[w.height] = second_nearer ? child.x : child.y;
        w.node = first || second ? (second_nearer ? child.y : child.x) : popped;
        w.height = both ? w.height + 1u : first || second ? w.height : w.height - 1u;
    }
    if (w.node >= BVH_LEAF && w.node < BVH_NOTHING) {
        uint index = w.node & BVH_FIRST_MASK;
        bool last = (w.node & BVH_COUNT_MASK) == 0u;
        uint popped = traversal_stack[w.height - 1u];
        w.node = last ? popped : w.node + 1u - BVH_COUNT_ONE;
        w.height = last ? w.height - 1u : w.height;
        Triangle primitive = primitives[index];
        GeometryHit found;
        bool met = false;
#if HAS_TRIANGLES
#if HAS_SHAPES || HAS_INSTANCES
        if (attributes_kind(primitive.attributes) == KIND_TRIANGLE)
#endif
            met = triangle_meet(w.shear, w.origin, w.direction, primitive.v0, primitive.v1, primitive.v2, HIT_LIMIT(w.hit),
                                found);
#endif
#if HAS_SHAPES
        if (attributes_kind(primitive.attributes) == KIND_SHAPE) {
            mat4x3 m = transform_at(floatBitsToUint(primitive.v0.y)).local_from_world;
            met = geometry_intersect(floatBitsToUint(primitive.v0.x), m * vec4(w.origin, 1.0),
                                     m * vec4(w.direction, 0.0), HIT_LIMIT(w.hit), found);
        }
#endif
#if HAS_PRIORITIES
        Hit candidate = Hit(found.t, found.uv, index, NO_RECORD);
#if HAS_INSTANCES
        candidate.instance = w.instance;
#endif
        met = met && comes_after(candidate, w.after) && comes_after(w.hit, candidate);
#endif
        if (met) {
            w.hit.t = found.t;
            w.hit.uv = found.uv;
            w.hit.primitive = index;
            w.limit = found.t - w.box.start;
            if (any_hit) w.node = BVH_NOTHING;
#if HAS_INSTANCES
            w.hit.instance = w.instance;
#endif
        }
#if HAS_INSTANCES
        if (attributes_kind(primitive.attributes) == KIND_INSTANCE) {
            uint header = floatBitsToUint(primitive.v0.x);
            mat4x3 m = transform_at(floatBitsToUint(primitive.v0.y)).local_from_world;
            if (!last) traversal_stack[w.height++] = w.node;
            else w.height++;  // what was popped still lies there
            traversal_stack[w.height++] = BVH_RETURN;
            traversal_enter(w, header, m * vec4(w.world_origin, 1.0), m * vec4(w.world_direction, 0.0));
            w.instance = index;
            w.node = nodes[header].w;
        }
#endif
    }
#if HAS_INSTANCES
    if (w.node == BVH_RETURN) {
        w.instance = NO_RECORD;
        traversal_enter(w, WORLD_HEADER, w.world_origin, w.world_direction);
        w.height--;
        w.node = traversal_stack[w.height];
    }
#endif
}

// The nearest hit with 0 < t < t_max. The direction need not be of unit length.
Hit find_hit(vec3 origin, vec3 direction, float t_max) {
    Traversal w;
    traversal_begin(w, origin, direction, t_max);
    while (w.node != BVH_NOTHING) traversal_step(w, false);
    return w.hit;
}

#if HAS_PRIORITIES
// The first hit after another one, which may have the same distance.
Hit find_hit_after(vec3 origin, vec3 direction, float t_max, Hit after) {
    Traversal w;
    traversal_begin(w, origin, direction, t_max);
    w.after = after;
    w.skipped = after.t * (1.0 - 4.0 * EPSILON) - w.box.start;
    while (w.node != BVH_NOTHING) traversal_step(w, false);
    return w.hit;
}
#endif

// Whether anything is hit with 0 < t < t_max.
bool find_occlusion(vec3 origin, vec3 direction, float t_max) {
    Traversal w;
    traversal_begin(w, origin, direction, t_max);
    while (w.node != BVH_NOTHING) traversal_step(w, true);
    return w.hit.primitive != NO_RECORD;
}
#endif
