// Crystals: double refraction at faces between them and what is around or beside them, of class dielectric (the host sees to it that
// faces of crystals are, and smooth). Kernels for other classes have none of it but the mode.
//
// Rays within a crystal are ordinary or extraordinary, each polarized in one way, so that S0 alone says all of them; a face sends
// a ray to one of up to four others, by the exact share of power that unpolarized light has there. Waves that leave a crystal along
// one direction are not added coherently: bodies thicker than the coherence length, not sheets (those are retarders).
//
// Backward rays carry radiance. That over n² (lib/crystal_waves.glsl) is kept, and of unpolarized light half of it belongs to each
// wave of a crystal.
#include "features/faces.glsl"
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"

#if HAS_CRYSTALS
#include "lib/crystal_interface.glsl"

#if defined(TAG_dielectric) && (!defined(ONLY_SURFACE_CLASS) || ONLY_SURFACE_CLASS == TAG_dielectric)
// Does the face separate a crystal from something else?
bool meets_crystal(uint surface, Crossing c) {
    if (record_tag(surface) != uint(TAG_dielectric) || c.above.medium == c.below.medium) return false;
    return is_crystal(medium_crystal(c.above.medium)) || is_crystal(medium_crystal(c.below.medium));
}

// In the frame of s.
Crystal crystal_beside(ScatteringPoint s, bool above) {
    Crystal m = medium_crystal(above ? s.sides.above.medium : s.sides.below.medium);
    if (!is_crystal(m)) return isotropic_medium(above ? s.context.ior_above : s.context.ior_below);
    m.axis = m.axis * s.frame;
    return m;
}

#if HAS_POLARIZATION
vec2 coherence(vec2 a, vec2 b) { return complex_product(a, conjugate(b)); }

// Of light that goes the way of the ray, if the path carries power, else against it: those are D Mᵀ D, D = diag(1, 1, -1, 1). The
// amplitudes are those of two waves, s and p, or of one of a crystal, whose Stokes vector is (1, 0, 0, 0).
Mueller crystal_mueller(CrystalFace f, uint first, bool two, bool importance, vec3 axis) {
    Mueller m = depolarizing();
    m.from = m.to = axis;
    m.is_general = true;
    // s and p of what goes, by s and p of what comes: ss, sp, ps, pp.
    vec2 j[4] = vec2[4](f.amplitudes[0][first], vec2(0), vec2(0), vec2(0));
    if (two) j[2] = f.amplitudes[0][first + 1u];
    if (f.incident == 2u) j[1] = f.amplitudes[1][first];
    if (two && f.incident == 2u) j[3] = f.amplitudes[1][first + 1u];
    for (int column = 0; column < 4; ++column) {
        // |Es|², |Ep|² and Es Ep* of a Stokes vector: S2 + i S3 = 2 conj(Es Ep*).
        float s = column < 2 ? 0.5 : 0.0, p = column == 0 ? 0.5 : column == 1 ? -0.5 : 0.0;
        vec2 sp = column == 2 ? vec2(0.5, 0) : column == 3 ? vec2(0, -0.5) : vec2(0);
        if (f.incident == 1u) s = column == 0 ? 1.0 : 0.0, p = 0.0, sp = vec2(0);
        float s_out = dot(j[0], j[0]) * s + dot(j[1], j[1]) * p + 2.0 * complex_product(coherence(j[0], j[1]), sp).x;
        float p_out = dot(j[2], j[2]) * s + dot(j[3], j[3]) * p + 2.0 * complex_product(coherence(j[2], j[3]), sp).x;
        vec2 sp_out = coherence(j[0], j[2]) * s + coherence(j[1], j[3]) * p + complex_product(coherence(j[0], j[3]), sp) +
                      complex_product(coherence(j[1], j[2]), conjugate(sp));
        vec4 stokes = vec4(s_out + p_out, s_out - p_out, 2.0 * sp_out.x, -2.0 * sp_out.y);
        if (!two) stokes = vec4(stokes.x, 0, 0, 0);
        for (int row = 0; row < 4; ++row) {
            float sign = (row == 2) != (column == 2) ? -1.0 : 1.0;
            if (importance) m.m[4 * row + column] = Spectrum(stokes[row]);
            else m.m[4 * column + row] = Spectrum(sign * stokes[row]);
        }
    }
    return m;
}
#endif

// What a face does, u in [0,1) spread evenly.
void cross_crystal(inout SurfaceEvent event, ScatteringPoint s, float u) {
    bool above = s.wo.z > 0.0;
    Crystal from = crystal_beside(s, above), to = crystal_beside(s, !above);
    vec3 n = vec3(0, 0, above ? -1 : 1), k = wave_vector(from, s.mode, -s.wo);
    vec3 along = k - dot(k, n) * n;
    float kx = length(along);
    vec3 x = kx > 1e-6 ? along / kx : vec3(1, 0, 0);
    mat3 frame = mat3(x, cross(n, x), n);
    from.axis = from.axis * frame, to.axis = to.axis * frame;
    CrystalFace f = crystal_face(from, to, s.mode, kx);

    vec4 powers;
    for (uint i = 0u; i < 4u; ++i) powers[i] = power_into(f, i);
    float all = powers.x + powers.y + powers.z + powers.w, left = u * all;
    uint wave = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        if (powers[i] > 0.0) wave = i;
        left -= powers[i];
        if (left < 0.0) break;
    }
    uint first = wave & 2u;  // of the two of its side
    bool two = f.isotropic[first >> 1u];
    if (!two) first = wave;
    float probability = (two ? powers[first] + powers[first + 1u] : powers[wave]) / all;
    Wave w = f.waves[wave];
    float kept = f.squared_index * (f.isotropic[0] ? 2.0 : 1.0) / (w.squared_index * (two ? 2.0 : 1.0));
    event.mode = two ? MODE_NONE : (wave & 1u) == 0u ? MODE_ORDINARY : MODE_EXTRAORDINARY;
    float power = HAS_SHADING_NORMALS == 1 ? abs(s.wo.z) : 1.0;  // see adjoint_correction()
    event.next = BsdfSample(frame * w.ray, Spectrum(s.context.importance ? power : kept), probability,
                            EVENT_DELTA | (wave < 2u ? EVENT_REFLECT : EVENT_TRANSMIT));
    event.next_pdf_reverse = probability;
    keep_mueller(event.next_mueller, crystal_mueller(f, first, two, s.context.importance, frame[1]));
}

#else
#define meets_crystal(surface, crossing) false
#define cross_crystal(event, s, u)
#endif

// Stokes parameters S1 to S3 over S0 of a crystal's ray, and x of their frame: it swings across the plane of ray and axis, or in it.
void crystal_polarization(vec3 ray, uint medium, uint mode, inout vec3 stokes, inout vec3 x) {
    if (mode == MODE_NONE) return;
    vec3 axis = medium_crystal(medium).axis;
    vec3 e = mode == MODE_ORDINARY ? cross(ray, axis) : axis - dot(axis, ray) * ray;
    float size = length(e);
    x = size > 1e-6 ? e / size : stokes_axis(ray);
    stokes = vec3(1, 0, 0);
}

#define start_mode(path) path.mode = MODE_NONE
#define mode_of(path) path.mode
#define keep_mode(holder, value) holder.mode = value
#else
#define meets_crystal(surface, crossing) false
#define cross_crystal(event, s, u)
#define crystal_polarization(ray, medium, mode, stokes, axis)
#define start_mode(path)
#define mode_of(path) 0u
#define keep_mode(holder, value)
#endif
