// Maxwell's fish-eye: n = ior / (1 + (r / radius)²), r being the distance from the centre. All rays are circles, and those from
// a point meet again at its image, in the same time (Born & Wolf, section 4.2.2). It absorbs along the bent path.
//
// Example:
//     {"materials": [{"name": "fish-eye", "extensions": {"ETD_optics": {
//         "surface": {"class": "dielectric"}, "inside": "fish-eye"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "fish-eye", "class": "fish_eye", "ior": 2, "center": [0, 0.5, 0], "radius": 0.5, "tolerance": 1e-3}]}}}
#include "lib/free_path.glsl"
#include "lib/plain_media.glsl"
#include "lib/records.glsl"

struct FishEye {
    SpectrumRef ior;         //: 2 in [0.1, 100] ior. Real refractive index at the centre.
    SpectrumRef absorption;  //: 0 in [0, inf) 1/m. Absorption coefficient.
    WorldPoint center;       //: [0, 0, 0] m. In the world.
    float radius;            //: 1 in (0, inf) m. Where the index is half of that at the centre.
    float tolerance;         //: 1e-6 in (0, inf) m. By which a bent ray may leave the chords that stand for it.
};

// n / ior, at d from the centre
float fish_eye_profile(FishEye r, vec3 d) { return 1.0 / (1.0 + dot(d, d) / (r.radius * r.radius)); }

Spectrum fish_eye_ior(FishEye r, vec3 position) {
    return untinted_value(r.ior) * fish_eye_profile(r, position - r.center.position);
}

bool fish_eye_bends(FishEye r) { return true; }

vec3 fish_eye_bending(FishEye r, vec3 position) {
    vec3 d = position - r.center.position;
    float profile = fish_eye_profile(r, d), n = of_hero(untinted_value(r.ior)) * profile;
    return (-2.0 * n * n * profile / (r.radius * r.radius)) * d;
}

StepLimits fish_eye_step_limits(FishEye r) { return StepLimits(r.tolerance, 0.25 * r.radius); }

bool fish_eye_is_clear(FishEye r) { return is_black(untinted_value(r.absorption)); }

Passage fish_eye_pass(FishEye r, MediumRay ray, uint seed) {
    Spectrum left = exp(-untinted_value(r.absorption) * ray.distance);
    return Passage(left, brightness(left));
}

NEVER_SCATTERS(FishEye, fish_eye)
