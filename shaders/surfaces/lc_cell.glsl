// A layer of nematic liquid crystal, as a sheet: what lies between the polarizers of a display. Its director turns from the side of the
// normal, where it is rubbed along `rubbing`, by `twist` to the other side. Lossless, and it reflects nothing.
//
// Light goes through slices of a uniaxial plate each: they hold light along and across the projected director back by the difference of
// the normal components of both wave vectors (extended Jones matrices: Lien 1990, "Extended Jones matrix representation for the twisted
// nematic liquid-crystal display at oblique incidence"). Without drive the director lies in the plane but for the pretilt; a drive of 1
// sets it upright in the middle of the layer. Colours take 611, 549 and 464 nm.
//
// Example:
//     {"materials": [
//         {"name": "display cell", "extensions": {"ETD_optics": {"surface": {"class": "lc_cell", "thickness": 4330, "ior_ordinary": 1.5, "ior_extraordinary": 1.6}}}},
//         {"name": "polarizer", "extensions": {"ETD_optics": {"surface": {"class": "linear_polarizer"}}}},
//         {"name": "analyser", "extensions": {"ETD_optics": {"surface": {"class": "linear_polarizer", "axis": 1.5707963}}}}],
//      "nodes": [
//         {"translation": [0, 0.5, -0.6], "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [1.2, 1], "material": 3}}}},
//         {"translation": [0, 0.5, 0.6], "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [1.2, 1], "material": 4}}}}]}
#include "lib/sheets.glsl"
#define LC_CELL_POLARIZES

struct LcCell {
    float rubbing;                  //: 0 in (-inf, inf) rad. Of the director on the side of the normal.
    float twist;                    //: 1.5707963 in (-inf, inf) rad. From there to the other side.
    float pretilt;                  //: 0 in [0, 1.5707963] rad. Of the director out of the plane, at both sides.
    float drive;                    //: 0 in [0, 1]. Of the field that tilts it.
    TextureRef drive_texture;       //: none data. Red multiplies drive: an image to show.
    SpectrumRef ior_ordinary;       //: 1.5 in [0.1, 100] ior. For light polarized across the director.
    SpectrumRef ior_extraordinary;  //: 1.6 in [0.1, 100] ior. Along it.
    float thickness;                //: 4330 in [0, 1e9] nm. Of the layer.
};

const uint LC_SLICES = 48u;  // transmittances within 1e-4

LcCell lc_cell_resolve(LcCell r, SurfaceContext c) {
    r.drive *= texture_value(r.drive_texture, c.uv0, c.uv1).r;
    return r;
}

Spectrum lc_cell_transparency(LcCell r, SurfaceContext c, vec3 wo) { return Spectrum(1); }

// The director at part `depth` of the way from the side of the normal.
vec3 lc_director(LcCell r, float depth) {
    float turn = (r.rubbing + r.twist * depth) * (0.5 * INV_PI);
    float upright = r.drive * cos_sin_turns(0.5 * depth).y;
    vec2 tilt = cos_sin_turns(mix(r.pretilt * (0.5 * INV_PI), 0.25, upright));
    return vec3(cos_sin_turns(turn) * tilt.x, tilt.y);
}

// Every slice turns the Stokes vector about the axis of its slow direction: rotations as quaternions w, (x, y, z), one a lane.
Mueller lc_cell_mueller(LcCell r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    Spectrum o2 = untinted_value(r.ior_ordinary), e2 = untinted_value(r.ior_extraordinary);
    o2 *= o2, e2 *= e2;
    Spectrum share = e2 / o2 - 1.0;
    vec2 tangential = to.xy * (to.z < 0.0 ? c.ior_above : c.ior_below);  // of the wave vector, in vacuum's
    float k2 = dot(tangential, tangential);
    float up = to.z < 0.0 ? -1.0 : 1.0;
    Spectrum q_o = up * sqrt(max(o2 - k2, Spectrum(0)));
    vec3 inside = normalize(vec3(tangential, brightness(q_o)));
    vec3 s = facet_axis(inside, vec3(0, 0, 1)), p = cross(inside, s);
    Spectrum phase_of_slice = 2.0 * PI * r.thickness / (float(LC_SLICES) * lane_wavelengths());
    Spectrum w = Spectrum(1), x = Spectrum(0), y = Spectrum(0), z = Spectrum(0);
    [[dont_unroll]] for (uint i = 0u; i < LC_SLICES; ++i) {
        float depth = (float(i) + 0.5) / float(LC_SLICES);
        vec3 n = lc_director(r, up < 0.0 ? depth : 1.0 - depth);
        // (1 + share nz²) q² + 2 share (k n) nz q + k² + share (k n)² - e² = 0: the root of waves that go on.
        float along = dot(tangential, n.xy);
        Spectrum a = 1.0 + share * (n.z * n.z), b = share * (along * n.z);
        Spectrum root = sqrt(max(b * b - a * (k2 + share * (along * along) - e2), Spectrum(0)));
        Spectrum q_e = (up * root - b) / a;
        vec3 e = axis_across(n, inside);
        float c1 = dot(e, s), c2 = dot(e, p);
        vec2 double_turn = vec2(c1 * c1 - c2 * c2, 2.0 * c1 * c2);  // of the slow axis, from s
        Spectrum cosine, sine;
        cos_sin(0.5 * phase_of_slice * up * (q_e - q_o), cosine, sine);
        // (cosine, sine (X, Y, 0)) times what the slices before have done.
        Spectrum X = sine * double_turn.x, Y = sine * double_turn.y;
        Spectrum w1 = cosine * w - X * x - Y * y, x1 = cosine * x + X * w + Y * z;
        Spectrum y1 = cosine * y + Y * w - X * z, z1 = cosine * z + X * y - Y * x;
        w = w1, x = x1, y = y1, z = z1;
    }
    Mueller m = depolarizing();
    m.from = m.to = facet_axis(to, vec3(0, 0, 1));
    m.is_general = true;
    for (int i = 0; i < 16; ++i) m.m[i] = Spectrum(i == 0 ? 1.0 : 0.0);
    m.m[5] = 1.0 - 2.0 * (y * y + z * z), m.m[6] = 2.0 * (x * y - w * z), m.m[7] = 2.0 * (x * z + w * y);
    m.m[9] = 2.0 * (x * y + w * z), m.m[10] = 1.0 - 2.0 * (x * x + z * z), m.m[11] = 2.0 * (y * z - w * x);
    m.m[13] = 2.0 * (x * z - w * y), m.m[14] = 2.0 * (y * z + w * x), m.m[15] = 1.0 - 2.0 * (x * x + y * y);
    return m;
}

SurfacePair lc_cell_evaluate(LcCell r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample lc_cell_sample(LcCell r, SurfaceContext c, vec3 wo, vec3 u) { return sheet_sample(wo, Spectrum(1)); }
bool lc_cell_is_delta(LcCell r, SurfaceContext c) { return true; }
bool lc_cell_is_opaque(LcCell r, SurfaceContext c) { return false; }
