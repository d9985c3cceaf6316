// Mueller matrices that are not of two blocks (lib/stokes.glsl), where a class of the scene has such.
#if HAS_GENERAL_MUELLER
#define not_general(mueller) mueller.is_general = false

void apply_general(Mueller m, Polarization p, bool transposed, inout Spectrum s0, inout Spectrum s1, inout Spectrum s2, inout Spectrum s3,
                   inout Spectrum unit) {
    if (!m.is_general) return;
    Spectrum s[4];
    for (int i = 0; i < 4; ++i) {
        ivec4 k = transposed ? ivec4(0, 4, 8, 12) + i : ivec4(0, 1, 2, 3) + 4 * i;
        s[i] = m.m[k.x] + m.m[k.y] * p.s1 + m.m[k.z] * p.s2 + m.m[k.w] * p.s3;
    }
    s0 = s[0], s1 = s[1], s2 = s[2], s3 = s[3], unit = m.m[0];
}
#else
#define not_general(mueller)
#define apply_general(m, p, transposed, s0, s1, s2, s3, unit)
#endif
