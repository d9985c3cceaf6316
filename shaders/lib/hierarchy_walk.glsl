// The walk of a ray through the scene's hierarchy (lib/bvh.glsl).
//
// On a CPU driver the lanes of a subgroup walk their rays together, so a step of the walk does at most one inner
// node and at most one primitive for each lane, and pushes and pops by selects instead of branches.

struct Traversal {
    vec3 origin, direction;  // in the frame being walked
    RayShear shear;
    BoxRay box;
    float limit;    // end of the ray as boxes see it
    uint node;      // reference to visit next; BVH_NOTHING when done
    uint height;    // of the stack
    Hit hit;        // hit.t is t_max until something is hit
    uint instance;  // that is being walked; NO_RECORD = none
    vec3 world_origin, world_direction;
    Hit after;      // only hits after this one count: with priorities
    float skipped;  // its distance as boxes see it, at most
};

// Entries: the deepest way down (bvh_max_depth of host/geometry/bvh.h) and what marks its ends, for instances twice. The host may
// know that less is enough.
uint traversal_stack[BVH_STACK_SIZE];

const uint WORLD_HEADER = 0u;  // entry of `nodes` where the scene's own tree starts

void traversal_enter(inout Traversal w, uint header, vec3 origin, vec3 direction) {
    w.origin = origin;
    w.direction = direction;
    w.box = box_ray(header, origin, direction);
    w.limit = w.hit.t - w.box.start;
    w.skipped = w.after.t * (1.0 - 4.0 * EPSILON) - w.box.start;
    w.shear = ray_shear(direction);
}

#include "features/instances.glsl"
#include "features/boundary_hits.glsl"
#include "features/twins.glsl"

void traversal_begin(out Traversal w, vec3 origin, vec3 direction, float t_max, const bool any_hit) {
    w.hit = Hit(t_max, vec2(0), NO_RECORD, NO_RECORD);
    w.after = Hit(0.0, vec2(0), NO_RECORD, NO_RECORD);
    uint header = tree_header();
    traversal_enter(w, header, origin, direction);
    w.node = nodes[header].w;
    traversal_stack[0] = BVH_NOTHING;
    w.height = 1u;
    w.world_origin = origin;
    w.world_direction = direction;
    w.instance = NO_RECORD;
}

#define traversal_end(w) w.node = BVH_NOTHING
#define is_done(w) (w.node == BVH_NOTHING)

void traversal_step(inout Traversal w, const bool any_hit) {
    if (w.node < BVH_LEAF) {
        vec2 near, far;
        uvec2 child;
        meet_boxes(w.box, w.node, w.limit, near, far, child);
        bool first = near.x <= far.x, second = near.y <= far.y;
        if (HAS_PRIORITIES == 1) first = first && far.x >= w.skipped, second = second && far.y >= w.skipped;
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
        if (is_triangle(primitive.attributes))
            met = triangle_meet(w.shear, w.origin, w.direction, primitive.v0, primitive.v1, primitive.v2, hit_limit(w.hit), found);
        judge_boundary(w, primitive, met, found);
        if (is_shape(primitive.attributes)) {
            mat4x3 m = transform_at(floatBitsToUint(primitive.v0.y)).local_from_world;
            met = geometry_intersect(floatBitsToUint(primitive.v0.x), m * vec4(w.origin, 1.0), m * vec4(w.direction, 0.0),
                                     hit_limit(w.hit), found);
        }
        Hit hit = Hit(found.t, found.uv, index, w.instance);
        if (HAS_TWINS == 1 && met) show_front(hit, primitive, w.direction);
        if (met && lies_between(hit, w.after, w.hit)) {
            w.hit = hit;
            w.limit = found.t - w.box.start;
            if (any_hit) w.node = BVH_NOTHING;
        }
        enter_instance(w, primitive, index, last);
    }
    leave_instance(w);
}

// The nearest hit with 0 < t < t_max. The direction need not be of unit length.
Hit find_hit(vec3 origin, vec3 direction, float t_max) {
    Traversal w;
    traversal_begin(w, origin, direction, t_max, false);
    while (!is_done(w)) traversal_step(w, false);
    return w.hit;
}

// The first hit after another one, which may have the same distance. Only with priorities.
Hit find_hit_after(vec3 origin, vec3 direction, float t_max, Hit after) {
    Traversal w;
    traversal_begin(w, origin, direction, t_max, false);
    w.after = after;
    w.skipped = after.t * (1.0 - 4.0 * EPSILON) - w.box.start;
    while (!is_done(w)) traversal_step(w, false);
    return w.hit;
}

// Whether anything is hit with 0 < t < t_max.
bool find_occlusion(vec3 origin, vec3 direction, float t_max) {
    Traversal w;
    traversal_begin(w, origin, direction, t_max, true);
    while (!is_done(w)) traversal_step(w, true);
    return w.hit.primitive != NO_RECORD;
}
