// What a path meets first, along bent rays and past faces that are not there.
#include "lib/bending.glsl"
#include "lib/scattering.glsl"
#include "lib/traversal.glsl"

struct FirstHit {
    bool found;
    SurfacePoint p;
    float distance;     // m, along the way; of bent rays along their chords
    uint medium_above;  // on the side of the normal, if the surface does not name it
};

// The path is left where it is met, with the direction that it has there.
FirstHit find_first(inout Path path) {
    FirstHit first;
    first.distance = 0.0;
    first.medium_above = path.medium;
#if HAS_BENDING || HAS_PRIORITIES
    uint steps = 0u;
    bool seeks = true;
    do {  // no loop that lanes leave one by one (see lib/light_selection.glsl)
        if (seeks) {
            float end = begin_ray(path);
            Hit hit = find_hit(path.origin, path.direction, end);
            first.found = hit.primitive != NO_RECORD;
            seeks = false;
            if (first.found) {
                first.p = locate(hit, path.origin, path.direction);
#if HAS_PRIORITIES
                Crossing crossing = meet_faces(path.origin, path.direction, path.bodies, hit, first.p);
#endif
#if HAS_BENDING
                if (is_bent(path)) seeks = !end_step_at(path, first.p, hit.t);
#endif
                if (!seeks) first.distance += hit.t;
#if HAS_PRIORITIES
                if (!seeks && !crossing.is_there) {
                    pass_faces(path, first.p, crossing);
                    seeks = true;
                }
                first.medium_above = medium_above(crossing, first.p, path.direction);
#endif
            }
#if HAS_BENDING
            else if (is_bent(path)) {
                first.distance += path.bend.chord;
                end_step(path);
                seeks = true;
            }
#endif
            if (++steps == MAX_STEPS) seeks = first.found = false;
        }
    } while (subgroupAny(seeks));
#else
    Hit hit = find_hit(path.origin, path.direction, INFINITY);
    first.found = hit.primitive != NO_RECORD;
    if (first.found) first.p = locate(hit, path.origin, path.direction);
    first.distance = hit.t;
#endif
    return first;
}
