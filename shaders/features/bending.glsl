// Paths through media that bend rays, a step of which is one ray of the path.
//
// No straight ray connects what lies behind a bend: for light sampling, connections and their weights it is a smooth surface
// that light has passed (features/mis.glsl), and shadow rays end where they meet such a medium.
#include "features/dispersion.glsl"
#include "features/polarization.glsl"
#include "features/weights.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

#if HAS_BENDING
#include "lib/bent_ray.glsl"

void start_bending(inout Path path) { path.bend = Bend(INFINITY, BentStep(vec3(0), vec3(0), vec3(0), vec3(0)), 0u); }
bool is_bent(Path path) { return path.bend.chord < INFINITY; }
bool bends_rays(uint medium) { return medium_bends(medium); }

float greatest_coordinate(vec3 p) { return max(abs(p.x), max(abs(p.y), abs(p.z))); }

void direct(inout Path path, vec3 direction) {
    turn_polarization(path, path.direction, direction);
    path.direction = direction;
}

// Readies the path for its next ray and returns where that ends at the latest (features/receptors.glsl: begin_ray).
float begin_step(inout Path path) {
    float longest = path.bend.chord;
    path.bend.chord = INFINITY;
    uint medium = path.around.medium;
    if (medium_bends(medium)) {
        forget_event(path);
        part_where_index_does(path, medium);
        // Beyond all geometry rays go straight on: a medium that is not closed has no end.
        if (!(dot(path.origin, path.origin) > SCENE_RADIUS * SCENE_RADIUS && dot(path.origin, path.direction) > 0.0)) {
            path.bend.step = bent_step(medium, path.origin, path.direction, longest);
            path.bend.chord = length(path.bend.step.chord);
            direct(path, path.bend.step.chord / path.bend.chord);
        }
    }
    // A little overlap, so that nothing falls between two steps.
    if (is_bent(path)) return path.bend.chord + 16.0 * EPSILON * (greatest_coordinate(path.origin) + path.bend.chord);
    return INFINITY;
}

// At `position`, on the chord or at its end: the path's direction is that of the bent ray there. Radiance changes with the
// squared index on the way (Veach 1997, section 5.2).
void turn(inout Path path, vec3 direction, vec3 position) {
    direct(path, direction);
    if (FORWARD == 0) {
        float index = medium_ior(path.around.medium, position);
        path.throughput *= dot(path.bend.step.start, path.bend.step.start) / (index * index);
    }
    path.bend.chord = INFINITY;
}

bool count_step(inout Path path, inout Counters counters) {
    if (++path.bend.steps < MAX_STEPS) return true;
    cut_path(path, counters);
    return false;
}

// The chord has met nothing. How far the ray has come, m.
float end_step(inout Path path) {
    float chord = path.bend.chord;
    path.origin += chord * path.direction;
    turn(path, normalize(path.bend.step.end), path.origin);
    return chord;
}

// The chord has met a surface at p. False: the bent ray, which leaves the chord by some tolerance, does not meet it there, since
// it goes to the side that the chord comes from; a shorter step will tell. That happens at grazing angles.
bool end_step_at(inout Path path, SurfacePoint p, float distance) {
    vec3 direction = normalize(optical_direction(path.bend.step, min(distance / path.bend.chord, 1.0)));
    if (dot(direction, p.geometric_normal) * dot(path.direction, p.geometric_normal) <= 0.0) {
        float shortest = 64.0 * EPSILON * greatest_coordinate(path.origin) + 4.0 * dot(abs(p.geometric_normal), p.error);
        if (path.bend.chord > shortest) {
            path.bend.chord *= 0.5;
            direct(path, normalize(path.bend.step.start));
            return false;
        }
        direction = path.direction;  // so short that it is the same
    }
    turn(path, direction, p.position);
    return true;
}

#else
#define start_bending(path)
#define is_bent(path) false
#define bends_rays(medium) false
#define begin_step(path) INFINITY
#define count_step(path, counters) true
#define end_step(path) 0.0
#define end_step_at(path, p, distance) true
#endif
