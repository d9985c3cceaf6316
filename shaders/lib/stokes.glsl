// Stokes vectors and Mueller matrices, as Mitsuba 3 has them (Jakob et al., "Polarization", Mitsuba 3 documentation):
//
//   frame     (x, y, z) right-handed, z the way light travels, seen by whom it reaches;
//   S1, S2    more of it swings along x than along y, along +45 degrees (counter-clockwise) than along -45 degrees;
//   S3        right-handed circular, clockwise as the receiver sees it;
//   media     n - ik, waves exp(+i omega t); at a surface x is the direction of s, across the plane of incidence, and amplitudes
//             have Verdet's signs: r_s = (n cos - n' cos') / (+), r_p = (n' cos - n cos') / (+).
//
// Where none is named, the frame of light that travels along d is that of stokes_axis(d), so that frames need not be kept.
#include "features/defaults.glsl"
#include "features/spectrum.glsl"
#include "lib/frames.glsl"
#include "lib/member_if.glsl"

vec3 stokes_axis(vec3 direction) { return frame_around(direction)[0]; }

// S1, S2 and S3 over S0. All that scales light leaves them as they are.
struct Polarization { Spectrum s1, s2, s3; };

Polarization unpolarized() { return Polarization(Spectrum(0), Spectrum(0), Spectrum(0)); }

// (cos, sin) of twice the angle by which x must be turned to lie along `axis`, counter-clockwise seen against `direction`. All
// are unit vectors, both axes across the direction.
vec2 double_angle(vec3 x, vec3 axis, vec3 direction) {
    float c = dot(x, axis), s = dot(cross(x, axis), direction);
    return vec2(c * c - s * s, 2.0 * s * c);
}

// The same light in a frame turned by half of that angle.
Polarization turned(Polarization p, vec2 angle) {
    return Polarization(angle.x * p.s1 + angle.y * p.s2, angle.x * p.s2 - angle.y * p.s1, p.s3);
}
Stokes turned(Stokes s, vec2 angle) {
    Polarization p = turned(Polarization(s[1], s[2], s[3]), angle);
    return Stokes(s[0], p.s1, p.s2, p.s3);
}

// What an event does to polarization, in units of what it lets through of unpolarized light: two blocks,
//
//     1  b   0   0
//     b  e   0   0      of a depolarizer, in part at least, e < 1. Else light along x and y is kept in the ratio (1 + b) : (1 - b), e is 1,
//     0  0   c  -d      and what swings at 45 degrees turns circular by the phase by which y is ahead of x: c and d are cos and sin
//     0  0   d   c      of it times 2 sqrt(X Y) / (X + Y), the share that stays coherent.
//
// Besides there is what features/body_mueller.glsl adds. `from` and `to` are x of the frames of light that comes and goes, in the
// frame of the surface. A class whose matrix is another says `is_general` and gives all of it, row by row and in any units;
// scenes without such classes have no room for that.
struct Mueller {
    vec3 from, to;
    Spectrum b, e, c, d;
    MEMBER_IF(HAS_BODY_MUELLER, Spectrum body;)
    MEMBER_IF(HAS_BODY_MUELLER, vec2 enters;)
    MEMBER_IF(HAS_BODY_MUELLER, vec2 leaves;)
    MEMBER_IF(HAS_GENERAL_MUELLER, bool is_general;)
    MEMBER_IF(HAS_GENERAL_MUELLER, Spectrum m[16];)
};
#include "features/body_mueller.glsl"
#include "features/general_mueller.glsl"

Mueller blocks(vec3 from, vec3 to, Spectrum b, Spectrum e, Spectrum c, Spectrum d) {
    Mueller m;
    m.from = from, m.to = to, m.b = b, m.e = e, m.c = c, m.d = d;
    no_body(m);
    not_general(m);
    return m;
}

// None is left.
Mueller depolarizing() { return blocks(vec3(1, 0, 0), vec3(1, 0, 0), Spectrum(0), Spectrum(0), Spectrum(0), Spectrum(0)); }

Mueller phase_plate(vec3 axis, Spectrum b, Spectrum c, Spectrum d) { return blocks(axis, axis, b, Spectrum(1), c, d); }

// Of light that nothing happens to.
Mueller passing(vec3 direction) { return phase_plate(stokes_axis(direction), Spectrum(0), Spectrum(1), Spectrum(0)); }

// Part of one and part of another, in the frames of the first.
Mueller mixed(Mueller m, Mueller other, Spectrum part_of_other) {
    m.b = mix(m.b, other.b, part_of_other), m.e = mix(m.e, other.e, part_of_other);
    m.c = mix(m.c, other.c, part_of_other), m.d = mix(m.d, other.d, part_of_other);
    return m;
}
// The rest is depolarized.
Mueller partly(Mueller m, Spectrum part) { return mixed(m, depolarizing(), 1.0 - part); }

// The first axis at a facet of normal h, where light goes along w: across the plane of incidence, any across the normal where light
// comes along it.
vec3 facet_axis(vec3 w, vec3 h) {
    vec3 s = cross(h, w);
    float l = dot(s, s);
    return l > 1e-12 ? s * inversesqrt(l) : stokes_axis(h);
}

// M applied to a Stokes vector, or (`transposed`) a row to M, in units of what M lets through of unpolarized light.
Stokes apply_mueller(Stokes s, Mueller m, bool transposed) {
    float sign = transposed ? -1.0 : 1.0;
    Stokes result = Stokes(s[0] + m.b * s[1], m.b * s[0] + m.e * s[1], m.c * s[2] - sign * m.d * s[3],
                           m.c * s[3] + sign * m.d * s[2]);
    apply_body(m, s, transposed, result);
    apply_general(m, s, transposed, result);
    return result;
}

// What becomes of p, of a vector or row (1, p); that is multiplied by the result, 0 to 2.
Spectrum split_stokes(Stokes s, out Polarization p) {
    Spectrum s0 = max(s[0], Spectrum(0));
    Spectrum inverse = mix(1.0 / s0, Spectrum(0), lessThanEqual(s0, Spectrum(1e-20)));
    p = Polarization(s[1] * inverse, s[2] * inverse, s[3] * inverse);
    return s0;
}

// The product of a row and a Stokes vector (1, light), in one frame.
Spectrum meet(Stokes row, Polarization light) { return row[0] + row[1] * light.s1 + row[2] * light.s2 + row[3] * light.s3; }
Spectrum meet(Polarization row, Polarization light) {
    return max(meet(Stokes(Spectrum(1), row.s1, row.s2, row.s3), light), Spectrum(0));
}
