// A sheet that lets part of the light through, by its colour, at every angle alike, and absorbs the rest. It leaves polarization as it is.
//
// Example:
//     {"materials": [{"name": "red glass", "extensions": {"ETD_optics": {
//         "surface": {"class": "color_filter", "transmittance": [0.8, 0.1, 0.05]}}}}]}
#include "lib/sheets.glsl"

struct ColorFilter {
    SpectrumRef transmittance;  //: required in [0, 1]. Part that passes.
};

ColorFilter color_filter_resolve(ColorFilter r, SurfaceContext c) { return r; }

Spectrum color_filter_transparency(ColorFilter r, SurfaceContext c, vec3 wo) { return untinted_value(r.transmittance); }

SurfacePair color_filter_evaluate(ColorFilter r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample color_filter_sample(ColorFilter r, SurfaceContext c, vec3 wo, vec3 u) {
    return sheet_sample(wo, color_filter_transparency(r, c, wo));
}
bool color_filter_is_delta(ColorFilter r, SurfaceContext c) { return true; }
bool color_filter_is_opaque(ColorFilter r, SurfaceContext c) { return false; }
