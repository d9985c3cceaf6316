// What a ray meets where the meshes of bodies overlap and their faces coincide (lib/bodies.glsl).
#include "lib/bodies.glsl"
#include "lib/materials.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

#if HAS_PRIORITIES
// The faces that a ray meets at one place.
struct Crossing {
    Bodies before, after;
    bool is_there;  // else the ray goes straight on
};

struct Faces {
    Crossing crossing;
    Bodies owed;       // bodies left that were never entered: the ray has been inside
    uint body;         // of the face that is seen
    bool has_explicit; // some face has no priority
    uint number;
    vec3 error;
};

// Adds a face that separates media; true: of all so far this one is seen, if any is.
bool add_face(inout Faces f, SurfacePoint p, vec3 direction) {
    Material m = materials[p.material];
    bool leaves = dot(direction, p.geometric_normal) > 0.0;
    f.number++;
    f.error = max(f.error, p.error);
    if (m.body == NO_RECORD) {
        if (f.has_explicit) return false;
        f.has_explicit = true;
        f.crossing.before.medium = leaves ? m.inside : m.outside;
        f.crossing.after.medium = leaves ? m.outside : m.inside;
        return f.body == NO_BODY;
    }
    if (!leaves) {
        if (body_count(f.owed, m.body) > 0u) leave_body(f.owed, m.body);
        else enter_body(f.crossing.after, m.body);
    } else {
        if (body_count(f.crossing.after, m.body) == 0u) enter_body(f.owed, m.body);
        else leave_body(f.crossing.after, m.body);
    }
    bool is_first = m.body < f.body;
    f.body = min(f.body, m.body);
    return is_first;
}

// Does what lies there bound a body, so that it is there only for some rays? What emits always is, and what lets nothing pass.
bool bounds_body(SurfacePoint p) {
    uint flags = materials[p.material].flags & (MATERIAL_SEPARATES_MEDIA | MATERIAL_BLOCKS);
    return p.light == NO_RECORD && flags == MATERIAL_SEPARATES_MEDIA;
}

// What the ray has met at `hit`, located as p. Where faces coincide, the liquid's with the inner wall of its glass say, all of
// them are found and crossed at once, whichever was hit, and p and `hit` become those of the one that is seen.
Crossing meet_faces(vec3 origin, vec3 direction, Bodies bodies, inout Hit hit, inout SurfacePoint p) {
    Faces f = Faces(Crossing(bodies, bodies, true), no_bodies(), NO_BODY, false, 0u, vec3(0));
    if (!bounds_body(p)) {
        if ((materials[p.material].flags & MATERIAL_SEPARATES_MEDIA) != 0u) add_face(f, p, direction);
        return f.crossing;
    }
    // More than the distances of two hits on one plane can differ by.
    vec3 n = abs(p.geometric_normal), reach = 16.0 * EPSILON * (abs(origin) + abs(p.position));
    float slack = dot(n, 4.0 * p.error + reach) / max(abs(dot(direction, p.geometric_normal)), 1e-6);
    float end = hit.t + slack;
    Hit seen = hit, last = Hit(hit.t - slack, vec2(0), NO_RECORD, NO_RECORD);
    SurfacePoint q = p;
    while (true) {
        Hit next = find_hit_after(origin, direction, end, last);
        if (next.primitive == NO_RECORD) break;
        last = next;
        SurfacePoint found = locate(next, origin, direction);
        bool coincides = abs(dot(found.position - p.position, p.geometric_normal)) <= 1.5 * dot(n, found.error + p.error);
        if (coincides && bounds_body(found) && add_face(f, found, direction)) {
            q = found;
            seen = next;
        }
    }
    if (f.number == 0u) add_face(f, p, direction);
    hit = seen;
    p = q;
    if (f.number > 1u) p.error = 4.0 * f.error;  // so that rays leave all of them behind
    f.crossing.before.counts |= f.owed.counts;
    uint before = first_body(f.crossing.before), after = first_body(f.crossing.after);
    f.crossing.is_there = before != after || (before == NO_BODY && f.has_explicit);
    return f.crossing;
}

// The medium on the side of the normal.
uint medium_above(Crossing c, SurfacePoint p, vec3 direction) {
    return medium_among(dot(direction, p.geometric_normal) > 0.0 ? c.after : c.before);
}

// Past faces that are not there.
void pass_faces(inout Path path, SurfacePoint p, Crossing c) {
    path.origin = origin_behind(path.origin, p.position, p.error, p.geometric_normal, path.direction);
    path.bodies = c.after;
}
#endif
