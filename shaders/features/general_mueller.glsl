// Mueller matrices that are not of two blocks (lib/stokes.glsl), where a class of the scene has such.
#if HAS_GENERAL_MUELLER
#define not_general(mueller) mueller.is_general = false

void apply_general(Mueller m, Stokes s, bool transposed, inout Stokes result) {
    if (!m.is_general) return;
    for (int i = 0; i < 4; ++i) {
        ivec4 k = transposed ? ivec4(0, 4, 8, 12) + i : ivec4(0, 1, 2, 3) + 4 * i;
        result[i] = (m.m[k.x] * s[0] + m.m[k.y] * s[1] + m.m[k.z] * s[2] + m.m[k.w] * s[3]) / m.m[0];
    }
}
#else
#define not_general(mueller)
#define apply_general(m, s, transposed, result)
#endif
