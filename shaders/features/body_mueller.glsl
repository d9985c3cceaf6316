// Light that goes into the body of a surface and comes out again: the body depolarizes it, the face that it passes polarizes it
// on both ways (Baek et al. 2018, "Simultaneous Acquisition of Polarimetric SVBRDF and Normals", section 4). Of classes that call
// set_body().
#if HAS_BODY_MUELLER
#define no_body(mueller) mueller.body = Spectrum(0), mueller.enters = mueller.leaves = vec2(0)

// `share`: of the unpolarized light, which the blocks depolarize; the rest is theirs. `enters`, `leaves`: S1 and S2 over S0 that
// the face makes of unpolarized light, and asks of what it lets in, in the frames `from` and `to`.
void set_body(inout Mueller m, Spectrum share, vec2 enters, vec2 leaves) { m.body = share, m.enters = enters, m.leaves = leaves; }

void apply_body(Mueller m, Stokes s, bool transposed, inout Stokes result) {
    vec2 first = transposed ? m.leaves : m.enters, last = transposed ? m.enters : m.leaves;
    Spectrum more = first.x * s[1] + first.y * s[2], all = m.body * (s[0] + more);
    result[0] += m.body * more;
    result[1] += last.x * all;
    result[2] += last.y * all;
}
#else
#define no_body(mueller)
#define set_body(m, share, enters, leaves)
#define apply_body(m, s, transposed, result)
#endif
