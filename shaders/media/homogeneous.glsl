// A medium that is the same everywhere: refractive index, absorption and scattering (Beer-Lambert).
//
// Example:
//     {"materials": [{"name": "green glass", "extensions": {"ETD_optics": {
//         "surface": {"class": "dielectric"}, "inside": "green glass"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "green glass", "class": "homogeneous", "ior": 1.52, "absorption": [4.5, 0.5, 2.6]}]}}}
#include "lib/free_path.glsl"
#include "lib/plain_media.glsl"

struct Homogeneous {
    SpectrumRef ior;         //: 1 in [0.1, 100] ior. Real refractive index.
    SpectrumRef absorption;  //: 0 in [0, inf) 1/m. Absorption coefficient.
    SpectrumRef scattering;  //: 0 in [0, inf) 1/m. Scattering coefficient.
    PhaseRef phase;          //: {"class":"isotropic"}. Phase function, by which it scatters.
};

Spectrum homogeneous_ior(Homogeneous r, vec3 position) { return untinted_value(r.ior); }

Spectrum homogeneous_extinction(Homogeneous r) { return untinted_value(r.absorption) + untinted_value(r.scattering); }

Passage homogeneous_pass(Homogeneous r, MediumRay ray, uint seed) {
    Spectrum left = exp(-homogeneous_extinction(r) * ray.distance);
    return Passage(left, brightness(left));
}

bool homogeneous_is_clear(Homogeneous r) { return is_black(homogeneous_extinction(r)); }

bool homogeneous_scatters(Homogeneous r) { return !is_black(untinted_value(r.scattering)); }

FreePath homogeneous_free_path(Homogeneous r, MediumRay ray, Spectrum carried, vec2 u, uint seed) {
    return sample_free_path(homogeneous_extinction(r), untinted_value(r.scattering), ray.distance, carried, u);
}

bool homogeneous_is_even(Homogeneous r) { return true; }

float homogeneous_mean_extinction(Homogeneous r, vec3 position) { return brightness(homogeneous_extinction(r)); }

Spectrum homogeneous_scattering(Homogeneous r, vec3 position) { return untinted_value(r.scattering); }

uint homogeneous_phase(Homogeneous r) { return r.phase.ref; }

NEVER_BENDS(Homogeneous, homogeneous)
