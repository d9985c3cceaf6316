// A sheet that lets light through that is polarized along its axis and reflects, as a mirror, light across it: wire grids, multilayer foils
// (DBEF). What is left of both is absorbed.
//
// Example:
//     {"materials": [{"name": "wire grid", "extensions": {"ETD_optics": {
//         "surface": {"class": "reflective_polarizer", "pass": 0.9, "block": 0.95}}}}]}
#include "lib/sheets.glsl"
#define REFLECTIVE_POLARIZER_POLARIZES

struct ReflectivePolarizer {
    float axis;         //: 0 in (-inf, inf) rad. Of transmission; seen projected.
    SpectrumRef pass;   //: 1 in [0, 1]. Transmittance for light polarized along the axis.
    SpectrumRef block;  //: 1 in [0, 1]. Reflectance for light polarized across it.
};

ReflectivePolarizer reflective_polarizer_resolve(ReflectivePolarizer r, SurfaceContext c) { return r; }

SurfacePair reflective_polarizer_evaluate(ReflectivePolarizer r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }

BsdfSample reflective_polarizer_sample(ReflectivePolarizer r, SurfaceContext c, vec3 wo, vec3 u) {
    Spectrum passes = 0.5 * untinted_value(r.pass), reflects = 0.5 * untinted_value(r.block);
    float sum = brightness(passes + reflects);
    if (!(sum > 0.0)) return no_bsdf_sample();
    float part = brightness(passes) / sum;
    if (u.z < part) return BsdfSample(-wo, passes / part, part, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
    return BsdfSample(vec3(-wo.xy, wo.z), reflects / (1.0 - part), 1.0 - part, EVENT_REFLECT | EVENT_DELTA);
}

// Reflected light swings in the sheet across the axis as before; as from a metal, p is half a wave from s.
Mueller reflective_polarizer_mueller(ReflectivePolarizer r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    vec3 axis = sheet_axis(r.axis);
    if ((event & EVENT_STRAIGHT) != 0u) return polarizer_mueller(axis_across(axis, to), untinted_value(r.pass), Spectrum(0));
    vec3 across = vec3(-axis.y, axis.x, 0.0);
    Mueller m = polarizer_mueller(axis_across(across, to), Spectrum(1), Spectrum(0));
    m.from = axis_across(across, from);
    return m;
}

Spectrum reflective_polarizer_transparency(ReflectivePolarizer r, SurfaceContext c, vec3 wo) { return 0.5 * untinted_value(r.pass); }
bool reflective_polarizer_is_delta(ReflectivePolarizer r, SurfaceContext c) { return true; }
bool reflective_polarizer_is_opaque(ReflectivePolarizer r, SurfaceContext c) { return max_component(untinted_value(r.pass)) <= 0.0; }
