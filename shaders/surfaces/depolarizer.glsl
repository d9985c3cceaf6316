// A sheet that lets all light through and leaves none of its polarization.
//
// Example:
//     {"materials": [
//         {"name": "depolarizer", "extensions": {"ETD_optics": {"surface": {"class": "depolarizer"}}}},
//         {"name": "polarizer", "extensions": {"ETD_optics": {"surface": {"class": "linear_polarizer"}}}},
//         {"name": "analyser", "extensions": {"ETD_optics": {"surface": {"class": "linear_polarizer", "axis": 1.5707963}}}}],
//      "nodes": [
//         {"translation": [0, 0.5, -0.6], "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [1.2, 1], "material": 3}}}},
//         {"translation": [0, 0.5, 0.6], "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [1.2, 1], "material": 4}}}}]}
#include "lib/sheets.glsl"

struct Depolarizer {
    uint unused;  // a record holds at least one member
};

Depolarizer depolarizer_resolve(Depolarizer r, SurfaceContext c) { return r; }

Spectrum depolarizer_transparency(Depolarizer r, SurfaceContext c, vec3 wo) { return Spectrum(1); }
Mueller depolarizer_mueller(Depolarizer r, SurfaceContext c, vec3 from, vec3 to, uint event) { return depolarizing(); }

SurfacePair depolarizer_evaluate(Depolarizer r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample depolarizer_sample(Depolarizer r, SurfaceContext c, vec3 wo, vec3 u) {
    return sheet_sample(wo, depolarizer_transparency(r, c, wo));
}
bool depolarizer_is_delta(Depolarizer r, SurfaceContext c) { return true; }
bool depolarizer_is_opaque(Depolarizer r, SurfaceContext c) { return false; }
