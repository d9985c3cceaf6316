// The state of a path between two events, and what every stage counts.
//
// What a kernel traces is set by the host before its source:
//   FORWARD           paths start at a light and carry flux instead of radiance
//   BIDIRECTIONAL     estimators from both ends are combined (lib/mis.glsl)
//   CONNECT_VERTICES  … also by connecting vertices of backward paths with vertices of forward paths
//   MERGE_VERTICES    … also by merging them
//   BEAMS             … in media that are the same everywhere along rays
//   FORWARD_ONLY      what forward rays can bring is brought by nothing else
#include "lib/bent_step.glsl"
#include "lib/bodies.glsl"
#include "lib/records.glsl"
#include "lib/sampler.glsl"
#include "lib/spectrum.glsl"

#ifndef BEAMS
#define BEAMS 0
#endif
#ifndef HAS_DISPERSION
#define HAS_DISPERSION 0
#endif
#define HAS_PATH_FLAGS (BIDIRECTIONAL || FORWARD_ONLY || HAS_DISPERSION)

#if HAS_BENDING
// Where the next ray is a step of a bent one (lib/bending.glsl).
struct Bend {
    float chord;   // m, its length; INFINITY = the ray goes straight. Between rays: what the next step is limited by
    BentStep step;
    uint steps;    // of the path so far
};
#endif

struct Path {
    vec3 origin;          // of the ray to trace next
    vec3 direction;       // unit; of a bent ray that of the chord
    Spectrum throughput;  // backward: what a unit of radiance along the ray contributes to the pixel; forward: flux that the ray
                          // carries, in units of the mean of all forward paths
    Spectrum radiance;    // collected so far
    vec3 reference;       // point where the direction was chosen
    float pdf;            // of choosing the direction there, 1/sr; 0 = one of finitely many (delta, camera)
    uint medium;          // RecordRef of the medium the ray is in
#if HAS_PRIORITIES
    Bodies bodies;        // that the ray is inside
#endif
#if HAS_SCATTERING
    float passage;        // of scattering media since the reference (interfaces/medium_optics.glsl)
#endif
#if HAS_BENDING
    Bend bend;
#endif
    uint depth;           // events so far
    Sampler random;
#if BIDIRECTIONAL
    float vcm, vc;        // lib/mis.glsl
    float pending;        // what merging at the last event adds to vc if the next one allows it
#if FORWARD
    uint light;           // where the path started
    vec3 light_normal;    // of its surface there
#endif
#endif
#if HAS_PATH_FLAGS
    uint flags;           // PATH_…
#endif
#if FORWARD
    uvec2 vertices;       // the last one stored of this path, and how many
#endif
#if MERGE_VERTICES && !FORWARD
    Spectrum bias;        // difference of merging with two radii, for the estimate of its bias
#endif
};

const uint PATH_STARTS = 1u;        // no event yet but passing straight on
const uint PATH_PARALLEL = 2u;      // started by a receiver of parallel rays
const uint PATH_MONOCHROME = 8u;   // only the hero wavelength is left
const uint PATH_AFTER_NARROW = 4u;  // the last event was at a narrow surface
const uint PATH_AFTER_BEAM = 16u;   // … in a medium where rays merge (lib/mis.glsl)

#if HAS_DISPERSION
// Where wavelengths part the path goes on with the hero alone, which stands for all four (Wilkie et al. 2014, section 3.1, with
// delta events: the others could not have gone this way). Once: whoever joins two such paths divides by four.
void make_monochrome(inout Path path) {
    if ((path.flags & PATH_MONOCHROME) != 0u) return;
    path.throughput *= Spectrum(4, 0, 0, 0);
    path.flags |= PATH_MONOCHROME;
}
#endif

// A ray that brings `contribution` to the pixel unless something stands in its way.
struct ShadowRay {
    vec3 origin;
    vec3 direction;
    float t_max;            // 0 = no ray
    Spectrum contribution;
    uint medium;
#if HAS_PRIORITIES
    Bodies bodies;
#endif
#if HAS_SCATTERING
    float others;           // of weigh(): the passage is known once the ray is traced
#if BEAMS
    float others_apart;     // that need no passage
#endif
#endif
#if FORWARD
    uint pixel;             // that it contributes to
#endif
};

ShadowRay no_shadow_ray() {
    ShadowRay ray;
    ray.origin = vec3(0), ray.direction = vec3(0, 0, 1), ray.t_max = 0.0, ray.contribution = Spectrum(0), ray.medium = NO_RECORD;
#if HAS_PRIORITIES
    ray.bodies = no_bodies();
#endif
#if HAS_SCATTERING
    ray.others = 0.0;
#if BEAMS
    ray.others_apart = 0.0;
#endif
#endif
#if FORWARD
    ray.pixel = 0u;
#endif
    return ray;
}

// The weight of a way to make a path, `others` being the density of all others relative to its own. With a single other in
// backward rays the power heuristic (Veach 1997, section 9.2.4), else the balance heuristic.
float mis_weight(float others) {
#if BIDIRECTIONAL
    return 1.0 / (1.0 + others);
#else
    return 1.0 / (1.0 + others * others);
#endif
}

// Weighs a connection. `others`: as far as they do not pass scattering media along it, which all of them must and it need not.
void weigh(inout ShadowRay ray, float others) {
#if HAS_SCATTERING
    ray.others = others;
#else
    ray.contribution *= mis_weight(others);
#endif
}

// A path of more events than this is cut, and what it carried is reported as lost: only a closed scene that absorbs
// nothing gets there (Russian roulette lets a path live for 65536 events with probability 1e-1400).
const uint MAX_DEPTH = 65536u;

// Of a bent path: the same is done with it then.
const uint MAX_STEPS = 65536u;

struct Counters {
    uint rays;                // segments traced
    uint shadow_rays;
    uint non_finite;          // samples dropped: not a number, or infinite
    uint depth_limit;         // paths cut at MAX_DEPTH
    float escaped;            // importance (1 a backward path) or flux (about 1 a forward path) that left the scene
    float depth_limit_lost;   // of the paths cut
#if FORWARD
    float emitted;            // flux
    float absorbed;
    float roulette;           // taken by Russian roulette, less what it gave to the survivors
#endif
};
