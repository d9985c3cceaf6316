// A wave plate: light polarized along its slow axis falls behind. Lossless, and it reflects nothing.
//
// Either by a retardance that is the same at every angle, or as a plate of a uniaxial crystal, or stretched film, whose optic axis
// lies in its plane: by the difference of the normal components of both wave vectors, thickness 2 pi / lambda (q_e - q_o) (Yeh & Gu
// 2010, "Optics of Liquid Crystal Displays", section 3.1). Colours take 611, 549 and 464 nm.
//
// Example:
//     {"materials": [
//         {"name": "quarter-wave plate", "extensions": {"ETD_optics": {"surface": {"class": "retarder", "retardance": 1.5707963}}}},
//         {"name": "polarizer", "extensions": {"ETD_optics": {"surface": {"class": "linear_polarizer"}}}},
//         {"name": "analyser", "extensions": {"ETD_optics": {"surface": {"class": "linear_polarizer", "axis": 1.5707963}}}}],
//      "nodes": [
//         {"translation": [0, 0.5, -0.6], "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [1.2, 1], "material": 3}}}},
//         {"translation": [0, 0.5, 0.6], "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [1.2, 1], "material": 4}}}}]}
#include "lib/sheets.glsl"
#define RETARDER_POLARIZES

struct Retarder {
    float axis;                   //: 0 in (-inf, inf) rad. The slow direction.
    SpectrumRef retardance;       //: none in [0, inf) rad. At every angle, instead of what follows. none = -1.
    SpectrumRef ior_ordinary;     //: 1.5443 in [0.1, 100] ior. For light polarized across the optic axis.
    SpectrumRef ior_extraordinary;  //: 1.5533 in [0.1, 100] ior. For light along it.
    float thickness;              //: 16190 in [0, 1e9] nm. Of the plate.
};

Retarder retarder_resolve(Retarder r, SurfaceContext c) { return r; }

Spectrum retarder_transparency(Retarder r, SurfaceContext c, vec3 wo) { return Spectrum(1); }

Mueller retarder_mueller(Retarder r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    vec3 slow = sheet_axis(r.axis);
    Spectrum retardance = untinted_value(r.retardance);
    if (max_component(retardance) >= 0.0) return wave_plate_mueller(axis_across(slow, to), retardance);
    Spectrum ordinary = untinted_value(r.ior_ordinary), extraordinary = untinted_value(r.ior_extraordinary);
    bool positive = brightness(extraordinary) >= brightness(ordinary);
    vec2 optic = positive ? slow.xy : vec2(-slow.y, slow.x);
    vec2 tangential = to.xy * (to.z < 0.0 ? c.ior_above : c.ior_below);  // of the wave vector, in vacuum's
    float along = dot(tangential, optic);
    Spectrum o2 = ordinary * ordinary, e2 = extraordinary * extraordinary;
    float k2 = dot(tangential, tangential);
    Spectrum q_o = sqrt(max(o2 - k2, Spectrum(0)));
    Spectrum q_e = sqrt(max(e2 - k2 - (e2 / o2 - 1.0) * (along * along), Spectrum(0)));
    // Within the plate; the fields' angle from the plane of incidence stays what it is outside.
    float up = to.z < 0.0 ? -1.0 : 1.0;
    vec3 inside = normalize(vec3(tangential, up * brightness(q_o)));
    vec3 o = axis_across(cross(inside, vec3(optic, 0.0)), inside), e = cross(inside, o);
    vec3 s = facet_axis(inside, vec3(0, 0, 1)), p = cross(inside, s);
    vec3 axis = positive ? e : o;
    vec3 s_outside = facet_axis(to, vec3(0, 0, 1));
    axis = dot(axis, s) * s_outside + dot(axis, p) * cross(to, s_outside);
    return wave_plate_mueller(axis, 2.0 * PI * r.thickness * abs(q_e - q_o) / lane_wavelengths());
}

SurfacePair retarder_evaluate(Retarder r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample retarder_sample(Retarder r, SurfaceContext c, vec3 wo, vec3 u) {
    return sheet_sample(wo, retarder_transparency(r, c, wo));
}
bool retarder_is_delta(Retarder r, SurfaceContext c) { return true; }
bool retarder_is_opaque(Retarder r, SurfaceContext c) { return false; }
