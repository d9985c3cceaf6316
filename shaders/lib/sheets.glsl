// Sheets of no thickness that light passes straight through. Angles are about the normal, from the tangent, counter-clockwise seen
// from the side of the normal.
#ifndef SURFACES_HAVE_TANGENTS
#define SURFACES_HAVE_TANGENTS  // features/normal_maps.glsl: frames follow the surface's tangent
#endif
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

// Light along the slow axis falls behind by `phase`.
Mueller wave_plate_mueller(vec3 slow, Spectrum phase) {
    Mueller m = phase_plate(slow, Spectrum(0), Spectrum(1), Spectrum(0));
    for (uint i = 0u; i < LANES; ++i) {
        vec2 cs = cos_sin_turns(phase[i] * (0.5 * INV_PI));
        m.m[10][i] = m.m[15][i] = cs.x;
        m.m[11][i] = -cs.y, m.m[14][i] = cs.y;
    }
    return m;
}

BsdfSample sheet_sample(vec3 wo, Spectrum transmittance) {
    if (is_black(transmittance)) return no_bsdf_sample();
    return BsdfSample(-wo, transmittance, 1.0, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
}
