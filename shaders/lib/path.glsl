// The state of a backward path between two events, and what every stage counts.
#include "lib/records.glsl"
#include "lib/sampler.glsl"
#include "lib/spectrum.glsl"

struct Path {
    vec3 origin;          // of the ray to trace next
    vec3 direction;       // unit
    Spectrum throughput;  // what a unit of radiance along the ray contributes to the pixel
    Spectrum radiance;    // collected so far
    vec3 reference;       // point where the direction was chosen
    float pdf;            // of choosing the direction there, 1/sr; 0 = one of finitely many (delta, camera)
    uint medium;          // RecordRef of the medium the ray is in
    uint depth;           // events so far
    Sampler random;
};

// A ray that brings `contribution` to the pixel unless something stands in its way.
struct ShadowRay {
    vec3 origin;
    vec3 direction;
    float t_max;            // 0 = no ray
    Spectrum contribution;
    uint medium;
};

ShadowRay no_shadow_ray() { return ShadowRay(vec3(0), vec3(0, 0, 1), 0.0, Spectrum(0), NO_RECORD); }

// A path of more events than this is cut, and what it carried is reported as lost: only a closed scene that absorbs
// nothing gets there (Russian roulette lets a path live for 65536 events with probability 1e-1400).
const uint MAX_DEPTH = 65536u;

struct Counters {
    uint rays;                // segments traced
    uint shadow_rays;
    uint non_finite;          // samples dropped: not a number, or infinite
    uint depth_limit;         // paths cut at MAX_DEPTH
    float escaped;            // importance (1 a path) that left the scene
    float depth_limit_lost;   // importance of the paths cut
};
