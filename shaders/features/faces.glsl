// What a ray meets where the meshes of bodies overlap and their faces coincide (features/bodies.glsl). Without priorities every
// face is there, and separates what its material says.
#include "features/bodies.glsl"
#include "lib/light_vertices.glsl"
#include "lib/materials.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

// The faces that a ray meets at one place.
struct Crossing {
    Surroundings above, below;               // on the side of the normal and below it
    MEMBER_IF(HAS_PRIORITIES, bool exists;)  // else the ray goes straight on
};

// On the side that a ray leaves to.
Surroundings surroundings_towards(Crossing c, SurfacePoint p, vec3 direction) {
    if (dot(direction, p.geometric_normal) > 0.0) return c.above;
    return c.below;
}

// What a face of no body separates, met from within `around`.
void sides_of(Material m, Surroundings around, out Surroundings above, out Surroundings below) {
    bool separates = (m.flags & MATERIAL_SEPARATES_MEDIA) != 0u;
    above = below = around;
    if (separates) above = surroundings_of(m.outside), below = surroundings_of(m.inside);
}

#if HAS_PRIORITIES
bool is_there(Crossing c) { return c.exists; }
bool bounds_by_priority(Material m) { return m.body != NO_RECORD; }

// Of a point where no face is.
Crossing no_crossing(Surroundings around) { return Crossing(around, around, true); }

// Forward vertices keep the medium on the side of their normal.
void keep_medium_above(inout LightVertex v, uint medium) { v.medium_above = medium; }

// Of a vertex at a surface, met from within `around`. Media alone: no ray goes on from there.
Crossing crossing_of_vertex(LightVertex v, uint material, Surroundings around) {
    Material m = materials[material];
    Crossing c = no_crossing(around);
    if (m.body != NO_RECORD) c.above = surroundings_of(v.medium_above), c.below = surroundings_of(m.inside);
    else sides_of(m, around, c.above, c.below);
    return c;
}

struct Faces {
    Surroundings before, after;  // whose medium is not found yet
    Surroundings owed;           // bodies left that were never entered: the ray has been inside
    uint body;                   // of the face that is seen
    bool has_explicit;           // some face has no priority
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
        f.before.outer = leaves ? m.inside : m.outside;
        f.after.outer = leaves ? m.outside : m.inside;
        return f.body == NO_BODY;
    }
    if (!leaves) {
        if (body_count(f.owed, m.body) > 0u) leave_body(f.owed, m.body);
        else enter_body(f.after, m.body);
    } else {
        if (body_count(f.after, m.body) == 0u) enter_body(f.owed, m.body);
        else leave_body(f.after, m.body);
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

// The faces as they lie about the normal of the one that is seen.
Crossing crossing_of(Faces f, SurfacePoint p, vec3 direction, bool exists) {
    find_medium(f.before);
    find_medium(f.after);
    bool leaves = dot(direction, p.geometric_normal) > 0.0;
    Crossing c = Crossing(f.after, f.before, exists);
    if (!leaves) c.above = f.before, c.below = f.after;
    return c;
}

// What the ray has met at `hit`, located as p. Where faces coincide, the liquid's with the inner wall of its glass say, all of
// them are found and crossed at once, whichever was hit, and p and `hit` become those of the one that is seen.
Crossing meet_faces(vec3 origin, vec3 direction, Surroundings around, inout Hit hit, inout SurfacePoint p) {
    Faces f = Faces(around, around, surroundings_of(NO_RECORD), NO_BODY, false, 0u, vec3(0));
    if (!bounds_body(p)) {
        if ((materials[p.material].flags & MATERIAL_SEPARATES_MEDIA) != 0u) add_face(f, p, direction);
        return crossing_of(f, p, direction, true);
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
    f.before.counts |= f.owed.counts;
    uint before = first_body(f.before), after = first_body(f.after);
    return crossing_of(f, p, direction, before != after || (before == NO_BODY && f.has_explicit));
}

// Past faces that are not there.
void pass_faces(inout Path path, SurfacePoint p, Crossing c) {
    path.origin = origin_behind(path.origin, p.position, p.error, p.geometric_normal, path.direction);
    path.around = surroundings_towards(c, p, path.direction);
}

#else
#define is_there(c) true
#define bounds_by_priority(m) false
Crossing no_crossing(Surroundings around) { return Crossing(around, around); }

#define keep_medium_above(v, medium)
Crossing sides_of_face(uint material, Surroundings around) {
    Crossing c;
    sides_of(materials[material], around, c.above, c.below);
    return c;
}
#define meet_faces(origin, direction, around, hit, p) sides_of_face(p.material, around)
#define crossing_of_vertex(v, material, around) sides_of_face(material, around)
#define pass_faces(path, p, c)
#endif
