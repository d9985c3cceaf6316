// Polarized light. A forward path carries a Stokes vector, a backward one a row that multiplies such vectors from the left: the first
// number is the path's throughput, the others stand beside it in units of that, in the frame of the light, which goes against backward
// rays. Directions, depths and Russian roulette are chosen without it, so that the densities of all ways to make a path stay as they
// are; an event takes or gives up to twice of what it does to unpolarized light.
//
// Rows and vectors meet where paths do (Mojzík et al. 2016, "Bi-directional Polarised Light Transport").
#include "lib/light_vertices.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"

#if HAS_POLARIZATION

void start_polarization(inout Path path) { path.polarization = unpolarized(); }

// A path comes to s along `arriving` and leaves along `leaving`, unit vectors: what becomes of what it carries, and by what that is
// multiplied.
Spectrum through_event(inout Polarization p, ScatteringPoint s, Mueller m, vec3 arriving, vec3 leaving) {
    bool transposed = !s.context.importance;
    vec3 before = transposed ? -arriving : arriving, after = transposed ? -leaving : leaving;  // of light
    p = turned(p, double_angle(stokes_axis(before), s.frame * (transposed ? m.to : m.from), before));
    Spectrum factor = apply_mueller(p, m, transposed);
    p = turned(p, double_angle(s.frame * (transposed ? m.from : m.to), stokes_axis(after), after));
    return factor;
}

void polarize(inout Path path, ScatteringPoint s, Mueller m, vec3 leaving) {
    path.throughput *= through_event(path.polarization, s, m, path.direction, leaving);
}

// … and casts a shadow ray.
void polarize_shadow(inout ShadowRay shadow, Path path, ScatteringPoint s, Mueller m) {
    shadow.polarization = path.polarization;
    shadow.contribution *= through_event(shadow.polarization, s, m, path.direction, shadow.direction);
}

// What a shadow ray passes straight through, at s.
void polarize_passage(inout ShadowRay shadow, ScatteringPoint s) {
    s.context.importance = FORWARD == 1;
    vec3 from = FORWARD == 1 ? s.wo : -s.wo;
    Mueller m = surface_transparency_mueller(s.surface, s.context, from);
    shadow.contribution *= through_event(shadow.polarization, s, m, shadow.direction, shadow.direction);
}

// The ray turns without an event, as in media that bend it.
void turn_polarization(inout Path path, vec3 before, vec3 after) {
    vec3 a = FORWARD == 1 ? before : -before, b = FORWARD == 1 ? after : -after;
    vec3 axis = stokes_axis(a), sum = a + b;
    axis -= sum * (2.0 * dot(sum, axis) / max(dot(sum, sum), 1e-30));  // mirrored across the bisecting plane, as a is to -b
    path.polarization = turned(path.polarization, double_angle(axis, stokes_axis(b), b));
}

// What forward vertices keep: light as it arrives, in half precision (an error of 5e-4).
PackedPolarization packed_polarization(Polarization p) {
    PackedPolarization packed;
    for (uint i = 0u; i < POLARIZATION_WORDS; ++i) packed.words[i] = 0u;
    for (uint i = 0u; i < 3u * LANES; ++i) {
        float value = i < LANES ? p.s1[i] : i < 2u * LANES ? p.s2[i - LANES] : p.s3[i - 2u * LANES];
        packed.words[i / 2u] |= packHalf2x16(vec2(value, 0)) << (16u * (i & 1u));
    }
    return packed;
}
Polarization polarization_of(LightVertex v) {
    Polarization p = unpolarized();
    for (uint i = 0u; i < 3u * LANES; ++i) {
        float value = unpackHalf2x16(v.polarization.words[i / 2u] >> (16u * (i & 1u))).x;
        if (i < LANES) p.s1[i] = value;
        else if (i < 2u * LANES) p.s2[i - LANES] = value;
        else p.s3[i - 2u * LANES] = value;
    }
    return p;
}
// The direction is kept with less precision, and the frame follows it.
void keep_polarization(inout LightVertex v, Path path) {
    vec3 kept = -decode_octahedral(v.direction);
    v.polarization =
        packed_polarization(turned(path.polarization, double_angle(stokes_axis(path.direction), stokes_axis(kept), kept)));
}

// A row comes to s and merges there with forward vertex y.
void polarize_merging(inout Spectrum brought, Path path, ScatteringPoint s, Mueller m, LightVertex y) {
    Polarization row = path.polarization;
    Spectrum factor = through_event(row, s, m, path.direction, decode_octahedral(y.direction));
    brought *= factor * meet(row, polarization_of(y));
}

#if CONNECT_VERTICES
// The light of y goes on at `there` to the end of a shadow ray, where it meets the row that has come along that.
void polarize_end(inout ShadowRay shadow, LightVertex y, ScatteringPoint there, Mueller m) {
    shadow.end = polarization_of(y);
    shadow.contribution *= through_event(shadow.end, there, m, -decode_octahedral(y.direction), -shadow.direction);
}
void end_unpolarized(inout ShadowRay shadow) { shadow.end = unpolarized(); }
#define analysed(shadow, brought) ((brought) * meet(shadow.polarization, shadow.end))
#else
#define end_unpolarized(shadow)
#define analysed(shadow, brought) brought
#endif

#else
#define start_polarization(path)
#define polarize(path, s, mueller, leaving)
#define polarize_shadow(shadow, path, s, mueller)
#define polarize_passage(shadow, s)
#define turn_polarization(path, before, after)
#define keep_polarization(v, path)
#define polarize_merging(brought, path, s, mueller, y)
#define polarize_end(shadow, y, there, mueller)
#define end_unpolarized(shadow)
#define analysed(shadow, brought) brought
#endif
