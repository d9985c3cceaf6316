// The state of a path between two events, and what every stage counts. In registers and in memory it is the same.
#include "features/bodies.glsl"
#include "features/elements.glsl"
#include "features/spectrum.glsl"
#include "features/defaults.glsl"
#include "lib/bent_step.glsl"
#include "lib/member_if.glsl"
#include "lib/sampler.glsl"
#include "features/film_layers.glsl"

// Where the next ray is a step of a bent one (features/bending.glsl).
struct Bend {
    float chord;   // m, its length; INFINITY = the ray goes straight. Between rays: what the next step is limited by
    BentStep step;
    uint steps;    // of the path so far
};

struct Path {
    vec3 origin;          // of the ray to trace next
    float pdf;            // of choosing the direction at the reference, 1/sr; 0 = one of finitely many (delta, camera)
    vec3 direction;       // unit; of a bent ray that of the chord
    uint depth;           // events so far
    vec3 reference;       // point where the direction was chosen
    uint flags;           // PATH_…
    Spectrum throughput;  // backward: what a unit of radiance along the ray contributes to the pixel; forward: flux that the ray
                          // carries, in units of the mean of all forward paths
    Surroundings around;  // what the ray is in
    Sampler random;
#if FORWARD
    uvec2 vertices;       // the last one stored of this path, and how many
    MEMBER_IF(HAS_SURFACE_METERS, uvec2 leaves;)  // watched primitive and side that the next ray leaves, and the view that is to
                                                  // know next (features/surface_meters.glsl); NO_RECORD = none
#else
    Collected radiance;   // so far
#endif
    MEMBER_IF(HAS_ELEMENTS, uint location;)             // whose frame it is in (features/elements.glsl)
    MEMBER_IF(HAS_POLARIZATION, Carried polarization;)  // features/polarization.glsl
    MEMBER_IF(HAS_LIGHT_LAYERS, uint history;) // features/light_layers.glsl
    MEMBER_IF(HAS_CRYSTALS, uint mode;)        // of the ray, within a crystal (features/crystals.glsl)
    MEMBER_IF(HAS_BENDING, Bend bend;)
    MEMBER_IF(HAS_SCATTERING, float passage;)  // of scattering media since the reference (features/weights.glsl)
    MEMBER_IF(BIDIRECTIONAL, float vcm;)       // features/mis.glsl
    MEMBER_IF(BIDIRECTIONAL, float vc;)
    MEMBER_IF(BIDIRECTIONAL, float pending;)   // what merging at the last event adds to vc if the next one allows it
#if FORWARD
    MEMBER_IF(BIDIRECTIONAL, uint light;)         // where the path started
    MEMBER_IF(BIDIRECTIONAL, vec3 light_normal;)  // of its surface there
#else
    MEMBER_IF(MERGE_VERTICES, Collected bias;)  // difference of merging with two radii, for the estimate of its bias
#endif
};

const uint PATH_STARTS = 1u;        // no event yet but passing straight on
const uint PATH_PARALLEL = 2u;      // started by a receiver of parallel rays
const uint PATH_AFTER_NARROW = 4u;  // the last event was at a narrow surface
const uint PATH_MONOCHROME = 8u;    // only the hero wavelength is left
const uint PATH_AFTER_BEAM = 16u;   // … in a medium where rays merge (features/mis.glsl)
const uint PATH_TO_RECEPTOR = 32u;    // what the ray meets first, if nothing stops it, is a receptor (features/receptors.glsl)
const uint PATH_HERO_SHIFT = 8u;      // two bits: the lane of the hero
const uint PATH_SHAPE_SHIFT = 10u;    // backward, three bits: of the receptor at which it starts
const uint PATH_VIEW_SHIFT = 13u;     // backward, the rest: the view of that, where receptors have shapes
const uint PATH_PASSED_SHIFT = 10u;   // forward, a bit a view from here on: the ray has passed its receptor

// A ray that brings `contribution` unless something stands in its way.
struct ShadowRay {
    vec3 origin;
    float t_max;            // 0 = no ray
    vec3 direction;
    uint target;            // what it contributes to: forward the pixel; backward the slot of its path (lib/wavefront.glsl)
    Spectrum contribution;
    Surroundings around;
    MEMBER_IF(HAS_ELEMENTS, uint location;)
    MEMBER_IF(HAS_POLARIZATION, Carried polarization;)
    MEMBER_IF(HAS_POLARIZED_ENDS, Polarization end;)  // of the light that leaves its end
    MEMBER_IF(HAS_LIGHT_LAYERS, uint history;)
    MEMBER_IF(HAS_SCATTERING, float others;)  // of weigh(): the passage is known once the ray is traced
    MEMBER_IF(BEAMS, float others_apart;)     // that need no passage
};

const float ALREADY_THERE = 1e-30;  // t_max of a ray whose end nothing hides

ShadowRay no_shadow_ray() {
    ShadowRay ray;
    ray.origin = vec3(0), ray.direction = vec3(0, 0, 1), ray.t_max = 0.0, ray.contribution = Spectrum(0), ray.target = 0u;
    ray.around = surroundings_of(NO_RECORD);
    return ray;
}

// Shadow rays that an event of a path casts at most: towards a light or the receiver, and towards a forward vertex.
const uint SHADOW_RAYS = CONNECT_VERTICES == 1 && FORWARD == 0 ? 2u : 1u;

// A path of more events than this is cut, and what it carried is reported as lost: only a closed scene that absorbs
// nothing gets there (Russian roulette lets a path live for 65536 events with probability 1e-1400).
const uint MAX_DEPTH = 65536u;

// Of a bent path: the same is done with it then.
const uint MAX_STEPS = 65536u;

struct Counters {
    uint rays;                // segments traced
    uint shadow_rays;
    uint non_finite;          // samples dropped: not a number, or infinite
    uint depth_limit;         // paths cut, at MAX_DEPTH for the most part
    float escaped;            // importance (1 a backward path) or flux (about 1 a forward path) that left the scene
    float depth_limit_lost;   // of the paths cut
#if FORWARD
    float emitted;            // flux
    float absorbed;
    float roulette;           // taken by Russian roulette, less what it gave to the survivors
#endif
};

// The path ends before its time.
void cut_path(Path path, inout Counters counters) {
    counters.depth_limit++;
    counters.depth_limit_lost += luminance(path.throughput);
}
