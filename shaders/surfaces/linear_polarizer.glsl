// A sheet that lets light through that is polarized along its axis and absorbs the rest; it reflects nothing.
//
// Seen at an angle, absorbing molecules (dyed or iodine foils, `absorbing`, O-type) let through what swings across the projected
// absorption axis; stretched foils of the other kind (`transmitting`, E-type) what swings along the projected axis of transmission
// (Korger et al. 2013, "The polarization properties of a tilted polarizer").
//
// Example:
//     {"materials": [{"name": "polarizing foil", "extensions": {"ETD_optics": {
//         "surface": {"class": "linear_polarizer", "parallel": 0.8, "crossed": 0.0001}}}}]}
#include "lib/sheets.glsl"
#define LINEAR_POLARIZER_POLARIZES

struct LinearPolarizer {
    float axis;            //: 0 in (-inf, inf) rad. Of transmission.
    SpectrumRef parallel;  //: 1 in [0, 1]. Transmittance for light polarized along the axis.
    SpectrumRef crossed;   //: 0 in [0, 1]. For light polarized across it.
    uint kind;             //: "absorbing" of absorbing|transmitting. The axis that is seen projected.
};

LinearPolarizer linear_polarizer_resolve(LinearPolarizer r, SurfaceContext c) { return r; }

Spectrum linear_polarizer_transparency(LinearPolarizer r, SurfaceContext c, vec3 wo) {
    return 0.5 * (untinted_value(r.parallel) + untinted_value(r.crossed));
}

Mueller linear_polarizer_mueller(LinearPolarizer r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    vec3 axis = sheet_axis(r.axis);
    vec3 x = r.kind == 0u ? cross(axis_across(vec3(-axis.y, axis.x, 0.0), to), to) : axis_across(axis, to);
    return polarizer_mueller(x, untinted_value(r.parallel), untinted_value(r.crossed));
}

SurfacePair linear_polarizer_evaluate(LinearPolarizer r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample linear_polarizer_sample(LinearPolarizer r, SurfaceContext c, vec3 wo, vec3 u) {
    return sheet_sample(wo, linear_polarizer_transparency(r, c, wo));
}
bool linear_polarizer_is_delta(LinearPolarizer r, SurfaceContext c) { return true; }
bool linear_polarizer_is_opaque(LinearPolarizer r, SurfaceContext c) { return false; }
