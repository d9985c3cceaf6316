// What a path meets first, along bent rays and past faces that are not there, and out of the element it is in: into one it does not
// look.
#include "features/bending.glsl"
#include "features/boundaries.glsl"
#include "features/receptors.glsl"
#include "features/faces.glsl"
#include "lib/scattering.glsl"
#include "lib/traversal.glsl"

struct FirstHit {
    bool found;
    SurfacePoint p;
    Crossing sides;  // of p
    float distance;  // m, along the way; of bent rays along their chords
};

// One ray of the path. True: there is another one to trace.
bool seek_first(inout Path path, inout FirstHit first) {
    float end = begin_ray(path);
    locate_ray(path.location);
    Hit hit = find_hit(path.origin, path.direction, end);
    first.found = hit.primitive != NO_RECORD;
    if (!first.found) {
        bool bent = is_bent(path), goes_out = !bent && within_element(path);
        if (bent) first.distance += end_step(path);
        if (goes_out) miss_boundary(path);
        return bent || goes_out;
    }
    first.p = locate(hit, path.origin, path.direction);
    first.sides = meet_faces(path.origin, path.direction, path.around, hit, first.p);
    if (is_bent(path) && !end_step_at(path, first.p, hit.t)) return true;
    first.distance += hit.t;
    if (meets_boundary(hit) && dot(path.direction, first.p.geometric_normal) > 0.0) {
        if (starts_within(hit, first.p, path.direction)) first.distance -= hit.t;
        pass_boundary(path, path.throughput, hit, first.p);
        return true;
    }
    if (is_there(first.sides)) return false;
    pass_faces(path, first.p, first.sides);
    return true;
}

// The path is left where it is met, with the direction that it has there.
FirstHit find_first(inout Path path) {
    FirstHit first;
    first.distance = 0.0;
    bool seeks = true;
    uint steps = 0u;
    do {  // no loop that lanes leave one by one (see features/light_selection.glsl)
        if (seeks) seeks = seek_first(path, first);
        if (++steps == MAX_STEPS && seeks) seeks = first.found = false;
    } while (subgroupAny(seeks));
    return first;
}
