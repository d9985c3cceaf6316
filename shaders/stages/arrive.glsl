// What the ray of a path comes to: a point of its medium where it scatters, a surface, or nothing; whichever way it goes.
#include "features/bending.glsl"
#include "features/boundaries.glsl"
#include "features/faces.glsl"
#include "features/receptors.glsl"
#include "lib/events.glsl"
#include "lib/traversal.glsl"

struct Arrival {
    bool is_event;   // else a bent ray has ended a step, or faces are not there, and the path goes on if it `lives`
    bool lives;
    bool scatters;   // at a point of the medium
    bool escapes;    // there is nothing; p is undefined
    bool caught;     // at a receptor
    SurfacePoint p;
    Crossing sides;  // of p
};

// The ray has crossed its medium to `hit`, where it `scatters`, or to what it has met; the path carried this before.
Arrival arrive(inout Path path, Spectrum carried, inout Hit hit, bool scatters, inout Counters counters) {
    Arrival a;
    locate_ray(path.location);
    a.is_event = a.lives = true;
    a.scatters = scatters;
    a.caught = is_caught(path, hit, scatters);
    a.escapes = !scatters && !a.caught && hit.primitive == NO_RECORD;
    a.sides = no_crossing(path.around);
    if (HAS_SCATTERING == 1 && scatters) {
        a.p = volume_point(path.origin + hit.t * path.direction, path.direction);
    } else if (!a.escapes) {
        if (a.caught) {
            a.p = receptor_point(path, hit);
        } else {
            forget_watched(path);
            a.p = locate(hit, path.origin, path.direction);
            a.sides = meet_faces(path.origin, path.direction, path.around, hit, a.p);
        }
        if (is_bent(path) && !end_step_at(path, a.p, hit.t)) {
            path.throughput = carried;
            a.is_event = false;
            a.lives = count_step(path, counters);
        } else if (!is_there(a.sides)) {
            pass_faces(path, a.p, a.sides);
            a.is_event = false;
        } else if (!a.caught && meets_boundary(hit)) {
            pass_boundary(path, carried, hit, a.p);
            a.lives = count_boundary(path, counters);
            a.is_event = false;
        }
    } else if (is_bent(path)) {
        end_step(path);
        a.is_event = false;
        a.lives = count_step(path, counters);
    } else if (within_element(path)) {
        miss_boundary(path);
        a.lives = count_boundary(path, counters);
        a.is_event = a.escapes = false;
    }
    return a;
}

// How light scatters there.
ScatteringPoint scattering_at(Path path, Arrival a) {
    if (HAS_SCATTERING == 1)
        if (a.scatters) return volume_scattering_point(a.p.position, path.direction, path.around, FORWARD == 1);
    ScatteringPoint s = met_point(a.p, path.direction, a.sides);
    keep_mode(s, path.mode);
    return s;
}
