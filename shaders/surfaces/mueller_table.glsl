// A surface that was measured with its polarization: a polarimetric BRDF of Baek et al. 2020, "Image-based acquisition and modeling of
// polarimetric reflectance", 1/sr, a table of Mueller matrices over directions and wavelengths in their format (scenes/FORMAT.md,
// "Measured surfaces"). Isotropic, both sides alike: from behind, directions are turned about an axis in the surface, so that what
// is handed stays so. Beyond the measured wavelengths the nearest holds; colours take 611, 549 and 464 nm. Samples follow how
// much facets of each slope reflect, some of them the cosine.
//
// Example:
//     {"materials": [{"name": "gold, with its polarization", "extensions": {"ETD_optics": {
//         "surface": {"class": "mueller_table", "file": "gold.pbsdf"}}}}]}
#define MUELLER_TABLE_POLARIZES

struct MuellerTableRef { uint index; };  // a file -> index of a MuellerTable (lib/mueller_table.glsl)

struct MuellerTableSurface {
    MuellerTableRef file;  //: required. Tensor file of Baek et al. (.pbsdf).
};

#include "lib/mueller_table.glsl"

MuellerTableSurface mueller_table_resolve(MuellerTableSurface r, SurfaceContext c) { return r; }

// Turned twice they are as before.
vec3 mueller_upright(vec3 w, bool below) { return below ? vec3(w.x, -w.yz) : w; }

Mueller mueller_table_mueller(MuellerTableSurface r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    if ((event & EVENT_STRAIGHT) != 0u) return depolarizing();  // nothing passes
    bool below = from.z < 0.0;
    Mueller m = mueller_table_matrix(mueller_tables[r.file.index], mueller_upright(from, below), mueller_upright(to, below));
    m.is_general = true;
    m.from = m.to = mueller_upright(m.from, below);
    return m;
}

SurfacePair mueller_table_evaluate(MuellerTableSurface r, SurfaceContext c, vec3 wo, vec3 wi) {
    bool below = wo.z < 0.0;
    return mueller_table_pair(mueller_tables[r.file.index], c.importance, mueller_upright(wo, below), mueller_upright(wi, below));
}

BsdfSample mueller_table_sample(MuellerTableSurface r, SurfaceContext c, vec3 wo, vec3 u) {
    bool below = wo.z < 0.0;
    BsdfSample s = mueller_table_sample(mueller_tables[r.file.index], mueller_upright(wo, below), u);
    s.wi = mueller_upright(s.wi, below);
    return s;
}

Spectrum mueller_table_transparency(MuellerTableSurface r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool mueller_table_is_delta(MuellerTableSurface r, SurfaceContext c) { return false; }
bool mueller_table_is_opaque(MuellerTableSurface r, SurfaceContext c) { return true; }
