// The media that paths start in (lib/start_media.glsl), one lane a question: at the receivers of the views and, with OF_LIGHTS, on either side
// of every light.
//
// A ray from there goes straight on to infinity. It starts in the medium that it first leaves without having entered it, or in
// the one that the first surface it enters names on its outside; where there is neither, in vacuum. Surfaces that separate
// nothing change nothing, but what lies behind an opaque one is no sure witness: the water of a pool ends at its walls, which
// name no medium. So many rays are asked, and the majority is believed (Boyer & Moore 1991, "MJRTY"): in scenes whose boundaries
// are closed all agree; a leak, an edge, an open end mislead a few. Answers from behind opaque surfaces count only where there
// are no others.
//
// Assumed: the receiver lies in one medium, and so does each side of a light (of a mesh: of each triangle). The sides differ
// only where the light's own surface separates media: then it is believed, not the majority. Lights at infinity are in vacuum.
//
// Of bodies with priorities (features/bodies.glsl) those hold the origin that a ray to infinity leaves more often than it enters them.
// Reads: scene. Writes: one word a question, or counts and a word. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint first, count;
};

#include "interfaces/light_source.glsl"
#include "features/boundaries.glsl"
#include "features/faces.glsl"
#include "features/light_selection.glsl"
#include "features/views.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"
#include "lib/sampler.glsl"
#include "lib/traversal.glsl"

layout(scalar, set = 0) writeonly buffer StartMedia { Surroundings start_media[]; };

const uint RAYS = 64u;
const int SURE = int(RAYS);      // weight of an answer that no opaque surface hides: more than all others together
const int ENOUGH = 4 * SURE;     // votes by which an answer leads when the rest need not be asked
const int CERTAIN = 2 * ENOUGH;  // of the light's own surface
const uint MOST_SURFACES = 512u; // that a ray meets; one that meets more says nothing
const uint MOST_ENTERED = 16u;   // media within each other, likewise

struct Witness {
    vec3 origin, direction;
    uint light;                  // that it starts at
    MEMBER_IF(HAS_ELEMENTS, uint location;)
    bool turns;                  // halfway to what it meets, so that it meets the light's own surface next
    uint surfaces;
    uint entered[MOST_ENTERED];  // media, and not left again
    uint depth;                  // how many
    int weight;                  // of the answer; 0 = none
    Surroundings since;          // bodies entered since the origin
    Surroundings answer;         // bodies that hold the origin, and the medium around them
    bool knows;                  // that medium
};

// Ray k of a question. False: there is none.
bool begin_witness(uint question, uint k, bool is_first, out Witness w) {
    Sampler random = start_sampler(uvec2(0), k, 0u);
    vec2 u_position = sample_2d(random), u_direction = sample_2d(random);
    w.direction = warp_sphere(sample_2d(random));
    w.surfaces = w.depth = 0u;
    w.weight = SURE;
    w.turns = false;
    w.since = w.answer = surroundings_of(NO_RECORD);
    w.knows = false;
    w.light = NO_RECORD - 1u;  // not that of surfaces that are no lights
    if (question < VIEW_COUNT) {
        View view = views[question];
        start_location(w, view.element);
        w.origin = receiver_emit(view.receiver, u_position, u_direction, film_aspect(view)).origin;
        return true;
    }
    question -= VIEW_COUNT;
    if (OF_LIGHTS == 0) return false;
    w.light = question / 2u;
    if (w.light < uint(INFINITE_LIGHT_COUNT)) return false;
    start_location(w, location_of_light(w.light));
    EmittedRay ray = light_emit(lights[w.light], scene_bounds(), u_position, u_direction);
    w.origin = offset_origin(ray.origin, ray.error, ray.normal, ray.direction);
    w.turns = is_first;
    if (is_first) w.direction = ray.normal;
    return ray.pdf > 0.0 && ray.front == ((question & 1u) == 0u);
}

// The ray has met a surface. True: it knows what medium it started in, bodies aside.
bool pass_surface(inout Witness w, SurfacePoint p, out uint medium) {
    Material m = materials[p.material];
    bool leaves = dot(w.direction, p.geometric_normal) > 0.0;
    bool separates = (m.flags & MATERIAL_SEPARATES_MEDIA) != 0u;
    w.origin = offset_origin(p.position, p.error, p.geometric_normal, w.direction);
    if (++w.surfaces >= MOST_SURFACES || (separates && !leaves && w.depth >= MOST_ENTERED)) w.weight = 0;
    medium = leaves ? m.inside : m.outside;
    if (w.weight == 0) return true;
    if (w.knows || bounds_by_priority(m)) return false;
    if (!separates) {
        if ((m.flags & MATERIAL_OPAQUE) != 0u) w.weight = 1;
        return false;
    }
    if (w.surfaces == 1u && p.light == w.light && (leaves || m.outside != NO_RECORD)) {
        w.weight = CERTAIN;
        return true;
    }
    if (!leaves) {
        if (w.depth == 0u && m.outside != NO_RECORD) return true;
        w.entered[w.depth++] = m.inside;
        return false;
    }
    uint found = w.depth;
    for (uint i = 0u; i < MOST_ENTERED; ++i)
        if (i < w.depth && w.entered[i] == m.inside) found = i;
    if (found == w.depth) return true;
    w.entered[found] = w.entered[--w.depth];
    return false;
}

// … and through that surface. True: the ray need go no further. Bodies with priorities need the whole ray.
bool pass_hit(inout Witness w, Hit hit) {
    SurfacePoint p = locate(hit, w.origin, w.direction);
    if (meets_boundary(hit)) {
        if (++w.surfaces >= MOST_SURFACES) w.weight = 0;
        go_through_boundary(w.origin, w.direction, w.location, hit, p);
        return w.weight == 0;
    }
    Crossing c = meet_faces(w.origin, w.direction, w.since, hit, p);
    count_bodies_left(w.answer, w.since, surroundings_towards(c, p, -w.direction));
    w.since = surroundings_towards(c, p, w.direction);
    uint medium;
    if (pass_surface(w, p, medium)) {
        w.knows = true;
        surround(w.answer, medium);
    }
    return w.weight == 0 || (w.knows && HAS_PRIORITIES == 0);
}

void main() {
    uint question = first + gl_GlobalInvocationID.x;
    bool done = question >= count;
    uint k = 0u;
    Surroundings best = surroundings_of(NO_RECORD);
    int lead = 0;
    bool walks = false;
    Witness w;
    // All lanes go round together, a surface at a time.
    do {
        if (!walks && !done) {
            walks = begin_witness(question, k, lead == 0, w);
            if (!walks) done = ++k == RAYS;
        }
        if (walks) {
            locate_ray(w.location);
            Hit hit = find_hit(w.origin, w.direction, INFINITY);
            bool answers = !w.turns;
            if (w.turns) {
                w.turns = false;
                w.origin += 0.5 * min(hit.t, SCENE_RADIUS) * w.direction;
                w.direction = -w.direction;
            } else if (hit.primitive != NO_RECORD) {
                answers = pass_hit(w, hit);
            }
            if (answers) {
                find_medium(w.answer);
                lead += w.answer == best ? w.weight : -w.weight;
                if (lead < 0) best = w.answer;
                lead = abs(lead);
                walks = false;
                done = ++k == RAYS || lead >= ENOUGH;
            }
        }
    } while (subgroupAny(!done));
    if (question < count) start_media[question] = best;
}
