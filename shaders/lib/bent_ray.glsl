// Rays through media whose refractive index n varies in space. With the optical direction T = n dR/ds at the position R and the
// parameter t, dt = ds / n, they obey dR/dt = T and dT/dt = n grad n = grad n² / 2, integrated by Runge-Kutta-Nyström steps of
// fourth order (Sharma, Kumar & Ghatak 1982, "Tracing rays through graded-index media: a new method").
//
// What a step meets is found along its chord, as along any ray. So its length is chosen by how far the bent ray leaves the
// chord, dt² / 8 times the part of grad n² / 2 across it: no more than the medium's tolerance. So far off may a ray be where it
// meets a surface. Its direction there, an interpolation of third order, and the ends of steps are more accurate by far.
#include "interfaces/medium_optics.glsl"

const uint MOST_TRIALS = 16u;  // of the length of a step; each shortens it to a tenth at most

float across(vec3 v, vec3 direction) { return length(v - dot(v, direction) * direction); }

// `direction` is unit; `longest` limits the chord, m.
BentStep bent_step(uint medium, vec3 position, vec3 direction, float longest) {
    StepLimits limits = medium_step_limits(medium);
    vec3 p = abs(position);
    // Positions are rounded: nothing is gained by shorter steps.
    float tolerance = max(limits.tolerance, 32.0 * EPSILON * max(p.x, max(p.y, p.z)));
    float index = medium_ior(medium, position);
    vec3 a = medium_bending(medium, position), b, c;
    BentStep s;
    s.start = index * direction;
    float bending = across(a, direction);
    // A little less than what would do if the bending stayed the same: most first trials succeed.
    float dt = min(min(limits.longest, longest) / index, sqrt(0.7 * 8.0 * tolerance / max(bending, 1e-30)));
    uint trials = 0u;
    bool tries = true;
    do {  // no loop that lanes leave one by one (see features/light_selection.glsl)
        if (tries) {
            b = medium_bending(medium, position + dt * (0.5 * s.start + 0.125 * dt * a));
            c = medium_bending(medium, position + dt * (s.start + 0.5 * dt * b));
            float most = max(bending, max(across(b, direction), across(c, direction)));
            float off = most * dt * dt * 0.125;
            tries = off > tolerance && ++trials < MOST_TRIALS;
            if (tries) dt *= max(0.1, 0.9 * pow(tolerance / off, 1.0 / 3.0));
        }
    } while (subgroupAny(tries));
    s.chord = dt * (s.start + (dt / 6.0) * (a + 2.0 * b));
    s.end = s.start + (dt / 6.0) * (a + 4.0 * b + c);
    // T(t) by the three values of grad n² / 2, then t by the part of the chord that is behind: along it the ray gains speed.
    vec3 gain = s.end - s.start;
    s.bow = 0.5 * dt * (a - c) + (0.5 * dt * dot(gain, s.chord) / dot(s.chord, s.chord)) * gain;
    return s;
}

vec3 optical_direction(BentStep s, float part) { return mix(s.start, s.end, part) + part * (1.0 - part) * s.bow; }
