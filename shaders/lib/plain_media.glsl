// What media that lack an effect answer (interfaces/medium_optics.glsl).
#include "lib/bent_step.glsl"
#include "lib/free_path.glsl"

#define NEVER_BENDS(Struct, name)                                                  \
    bool name##_bends(Struct r) { return false; }                                  \
    vec3 name##_bending(Struct r, vec3 position) { return vec3(0); }               \
    StepLimits name##_step_limits(Struct r) { return StepLimits(INFINITY, INFINITY); }

#define NEVER_SCATTERS(Struct, name)                                                                                   \
    bool name##_scatters(Struct r) { return false; }                                                                   \
    FreePath name##_free_path(Struct r, MediumRay ray, Spectrum carried, vec2 u, uint seed) {                          \
        return FreePath(false, ray.distance, Spectrum(1), 1.0);                                                        \
    }                                                                                                                  \
    bool name##_is_even(Struct r) { return false; }                                                                    \
    float name##_mean_extinction(Struct r, vec3 position) { return 0.0; }                                              \
    Spectrum name##_scattering(Struct r, vec3 position) { return Spectrum(0); }                                        \
    uint name##_phase(Struct r) { return NO_RECORD; }
