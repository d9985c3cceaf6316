// A sheet that does what a Mueller matrix says to light that passes straight through, or, with `reflects`, that is reflected as by a
// mirror. That holds for light from the side of the normal, at every angle and wavelength; for light from behind follows, by
// reciprocity, diag(1, 1, -1, 1) times the transposed matrix times that. x of all frames is the projected axis. The matrix must be
// physical: no more light than came, and no more polarization than light (Cloude 1990, "Conditions for the physical realisability of
// matrix operators in polarimetry"). With a `file` instead of a matrix, and nothing beside it, it is a `mueller_table`.
//
// Example:
//     {"materials": [{"name": "right circular polarizer", "extensions": {"ETD_optics": {
//         "surface": {"class": "mueller", "matrix": [0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5]}}}}]}
#include "lib/sheets.glsl"
#define MUELLER_POLARIZES

struct MuellerMatrix {
    vec4 row0, row1, row2, row3;
};

struct MuellerSheet {
    MuellerMatrix matrix;  //: required. 16 numbers, row by row.
    float axis;            //: 0 in (-inf, inf) rad. Of x.
    bool reflects;         //: false. Light is reflected instead of passing.
};

MuellerSheet mueller_resolve(MuellerSheet r, SurfaceContext c) { return r; }

Spectrum mueller_transparency(MuellerSheet r, SurfaceContext c, vec3 wo) { return Spectrum(r.reflects ? 0.0 : r.matrix.row0.x); }

Mueller mueller_mueller(MuellerSheet r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    Mueller m = depolarizing();
    m.is_general = true;
    m.from = axis_across(sheet_axis(r.axis), from), m.to = axis_across(sheet_axis(r.axis), to);
    mat4 columns = mat4(r.matrix.row0, r.matrix.row1, r.matrix.row2, r.matrix.row3);  // rows as columns
    bool behind = from.z < 0.0;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            float value = behind ? columns[k][i] : columns[i][k];
            m.m[4 * i + k] = Spectrum(behind && (i == 2) != (k == 2) ? -value : value);
        }
    return m;
}

SurfacePair mueller_evaluate(MuellerSheet r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample mueller_sample(MuellerSheet r, SurfaceContext c, vec3 wo, vec3 u) {
    Spectrum part = Spectrum(r.matrix.row0.x);
    if (!r.reflects || is_black(part)) return sheet_sample(wo, part);
    return BsdfSample(vec3(-wo.xy, wo.z), part, 1.0, EVENT_REFLECT | EVENT_DELTA);
}
bool mueller_is_delta(MuellerSheet r, SurfaceContext c) { return true; }
bool mueller_is_opaque(MuellerSheet r, SurfaceContext c) { return r.reflects; }
