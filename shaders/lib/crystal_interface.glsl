// What becomes of a wave at a plane between any two media, isotropic or uniaxial: up to two waves go back and two go on, with
// amplitudes that keep E and H along the plane continuous. One linear system for every pair of media and for total reflection,
// in which some waves die away (McClain, Hillman & Chipman 1993, "Polarization ray tracing in anisotropic optically active media").
#include "lib/crystal_waves.glsl"

// Of the plane's frame: x along the part of K in the plane, z to the side where light goes on.
struct CrystalFace {
    Wave waves[4];          // that go back (two), and on
    vec2 amplitudes[2][4];  // of these for unit power that comes as s or p of an isotropic medium, else in the first row
    uint incident;          // rows in use
    float squared_index;    // of what comes
    bool isotropic[2];      // media, of what comes back and what goes on
};

// Solves m x = rhs for two right sides at once; the columns 4 and 5 of the rows hold them, and then the solutions.
void solve(inout vec2 m[4][6]) {
    for (int c = 0; c < 4; ++c) {
        int pivot = c;
        for (int r = c + 1; r < 4; ++r)
            if (dot(m[r][c], m[r][c]) > dot(m[pivot][c], m[pivot][c])) pivot = r;
        vec2 inverse = conjugate(m[pivot][c]) / max(dot(m[pivot][c], m[pivot][c]), 1e-37);
        for (int k = c; k < 6; ++k) {
            vec2 value = complex_product(m[pivot][k], inverse);
            m[pivot][k] = m[c][k];
            m[c][k] = value;
        }
        for (int r = 0; r < 4; ++r) {
            if (r == c) continue;
            vec2 factor = m[r][c];
            for (int k = c; k < 6; ++k) m[r][k] -= complex_product(factor, m[c][k]);
        }
    }
}

// `from` and `to`: the media, with axes in the plane's frame; kx: of K.
CrystalFace crystal_face(Crystal from, Crystal to, uint mode, float kx) {
    CrystalFace f;
    f.isotropic[0] = !is_crystal(from), f.isotropic[1] = !is_crystal(to);
    f.incident = f.isotropic[0] ? 2u : 1u;
    for (uint i = 0u; i < 4u; ++i) {
        Crystal m = from;
        if (i >= 2u) m = to;
        f.waves[i] = wave_at_plane(m, kx, i < 2u ? -1.0 : 1.0, (i & 1u) == 1u);
    }
    vec2 m[4][6];
    for (uint k = 0u; k < f.incident; ++k) {
        Wave w = wave_at_plane(from, kx, 1.0, f.isotropic[0] ? k == 1u : mode == MODE_EXTRAORDINARY);
        f.squared_index = w.squared_index;
        for (int r = 0; r < 4; ++r) m[r][4 + k] = w.fields[r];
    }
    for (int r = 0; r < 4; ++r) {
        for (int i = 0; i < 4; ++i) m[r][i] = i < 2 ? -f.waves[i].fields[r] : f.waves[i].fields[r];
        if (f.incident == 1u) m[r][5] = vec2(0);
    }
    solve(m);
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 4; ++i) f.amplitudes[k][i] = m[i][4 + k];
    return f;
}

// The part of unpolarized power, or of that of a crystal's wave, that goes into a wave.
float power_into(CrystalFace f, uint wave) {
    if (!f.waves[wave].travels) return 0.0;
    float power = dot(f.amplitudes[0][wave], f.amplitudes[0][wave]);
    return f.incident == 2u ? 0.5 * (power + dot(f.amplitudes[1][wave], f.amplitudes[1][wave])) : power;
}
