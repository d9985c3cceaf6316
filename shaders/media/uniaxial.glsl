// A crystal of one optic axis (calcite, quartz, sapphire, ice): light that enters it goes on as two rays, polarized across each
// other, each with its refractive index, direction and absorption. Its faces must be smooth dielectrics; it does not scatter.
// What both rays bring along one direction behind it does not interfere: thin sheets are retarders.
//
// Example:
//     {"materials": [{"name": "calcite", "extensions": {"ETD_optics": {
//         "surface": {"class": "dielectric"}, "inside": "calcite"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "calcite", "class": "uniaxial", "ior_ordinary": 1.6584, "ior_extraordinary": 1.4864, "axis": [1, 1, 1]}]}}}
#include "lib/crystal_waves.glsl"
#include "lib/free_path.glsl"
#include "lib/plain_media.glsl"

#define UNIAXIAL_POLARIZES

struct Uniaxial {
    SpectrumRef ior_ordinary;              //: required in [0.1, 100] ior. Of light that swings across the axis.
    SpectrumRef ior_extraordinary;         //: required in [0.1, 100] ior. Of light that swings along the axis.
    Direction axis;                        //: [0, 0, 1]. Optic axis, in the world, of any length.
    SpectrumRef absorption_ordinary;       //: 0 in [0, inf) 1/m. Absorption coefficient of light that swings across the axis.
    SpectrumRef absorption_extraordinary;  //: 0 in [0, inf) 1/m. … along the axis.
};

Crystal uniaxial_crystal(Uniaxial r) {
    return Crystal(of_hero(untinted_value(r.ior_ordinary)), of_hero(untinted_value(r.ior_extraordinary)), r.axis.unit);
}

// On average over directions of vibration.
Spectrum uniaxial_ior(Uniaxial r, vec3 position) {
    return (2.0 * untinted_value(r.ior_ordinary) + untinted_value(r.ior_extraordinary)) / 3.0;
}

// Of an extraordinary ray, which swings along the axis as far as it can: E is across the ray, and what is absorbed of its power goes
// with the imaginary part of the permittivity along E, that is with n times the coefficient.
Passage uniaxial_pass(Uniaxial r, MediumRay ray, uint seed) {
    Spectrum absorption = untinted_value(r.absorption_ordinary);
    if (ray.mode == MODE_EXTRAORDINARY) {
        Crystal m = uniaxial_crystal(r);
        float cosine = dot(ray.direction, m.axis), c2 = cosine * cosine;
        absorption = (m.ordinary * c2 * absorption + m.extraordinary * (1.0 - c2) * untinted_value(r.absorption_extraordinary)) /
                     ray_index(m, cosine);
    }
    Spectrum left = exp(-absorption * ray.distance);
    return Passage(left, brightness(left));
}

bool uniaxial_is_clear(Uniaxial r) {
    return is_black(untinted_value(r.absorption_ordinary)) && is_black(untinted_value(r.absorption_extraordinary));
}

NEVER_SCATTERS(Uniaxial, uniaxial)
NEVER_BENDS(Uniaxial, uniaxial)
