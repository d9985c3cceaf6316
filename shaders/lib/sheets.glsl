// Sheets of no thickness that light passes straight through. Angles are about the normal, from the tangent, counter-clockwise seen
// from the side of the normal.
#define SURFACES_HAVE_TANGENTS  // features/normal_maps.glsl: frames follow the surface's tangent
#include "lib/accurate_math.glsl"
#include "lib/stokes.glsl"

vec3 sheet_axis(float angle) { return vec3(cos_sin_turns(angle * (0.5 * INV_PI)), 0.0); }

// The part of an axis across light that goes along `direction`; any where there is none.
vec3 axis_across(vec3 axis, vec3 direction) {
    vec3 a = axis - direction * dot(axis, direction);
    float l = dot(a, a);
    return l > 1e-12 ? a * inversesqrt(l) : stokes_axis(direction);
}

// Of the two transmittances, or reflectances, of light along and across the axis.
Mueller polarizer_mueller(vec3 axis, Spectrum along, Spectrum across) {
    Spectrum inverse = 1.0 / max(along + across, Spectrum(1e-30));
    return phase_plate(axis, (along - across) * inverse, 2.0 * sqrt(along * across) * inverse, Spectrum(0));
}

void cos_sin(Spectrum angle, out Spectrum cosine, out Spectrum sine) {
    for (uint i = 0u; i < LANES; ++i) {
        vec2 cs = cos_sin_turns(angle[i] * (0.5 * INV_PI));
        cosine[i] = cs.x, sine[i] = cs.y;
    }
}

// Light along the slow axis falls behind by `phase`.
Mueller wave_plate_mueller(vec3 slow, Spectrum phase) {
    Spectrum cosine, sine;
    cos_sin(phase, cosine, sine);
    return phase_plate(slow, Spectrum(0), cosine, sine);
}

BsdfSample sheet_sample(vec3 wo, Spectrum transmittance) {
    if (is_black(transmittance)) return no_bsdf_sample();
    return BsdfSample(-wo, transmittance, 1.0, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
}
