// Stokes vectors and Mueller matrices, as Mitsuba 3 has them (Jakob et al., "Polarization", Mitsuba 3 documentation):
//
//   frame     (x, y, z) right-handed, z the way light travels, seen by whom it reaches;
//   S1, S2    more of it swings along x than along y, along +45 degrees (counter-clockwise) than along -45 degrees;
//   S3        right-handed circular, clockwise as the receiver sees it;
//   media     n - ik, waves exp(+i omega t); at a surface x is the direction of s, across the plane of incidence, and amplitudes
//             have Verdet's signs: r_s = (n cos - n' cos') / (+), r_p = (n' cos - n cos') / (+).
//
// Where none is named, the frame of light that travels along d is that of stokes_axis(d), so that frames need not be kept.
#include "features/spectrum.glsl"
#include "lib/frames.glsl"

vec3 stokes_axis(vec3 direction) { return frame_around(direction)[0]; }

// S1, S2 and S3 over S0. All that scales light leaves them as they are.
struct Polarization { Spectrum s1, s2, s3; };

Polarization unpolarized() { return Polarization(Spectrum(0), Spectrum(0), Spectrum(0)); }

// (cos, sin) of twice the angle by which x must be turned to lie along `axis`, counter-clockwise seen against `direction`.
vec2 double_angle(vec3 x, vec3 axis, vec3 direction) {
    float c = dot(x, axis), s = dot(cross(x, axis), direction);
    return vec2(c * c - s * s, 2.0 * s * c) / max(c * c + s * s, 1e-30);
}

// The same light in a frame turned by half of that angle.
Polarization turned(Polarization p, vec2 angle) {
    return Polarization(angle.x * p.s1 + angle.y * p.s2, angle.x * p.s2 - angle.y * p.s1, p.s3);
}

// What an event does to polarization: the matrix in units of what the event lets through of unpolarized light, m[0] (any number
// above 0), by rows. `from` and `to` are the first axes of the frames of light that comes and goes, in the frame of the surface.
struct Mueller {
    vec3 from, to;
    Spectrum m[16];
};

// None is left.
Mueller depolarizing() {
    Mueller m;
    m.from = m.to = vec3(1, 0, 0);
    for (int i = 0; i < 16; ++i) m.m[i] = Spectrum(i == 0 ? 1.0 : 0.0);
    return m;
}

// A matrix of two blocks: light along x and y is kept in the ratio (1 + b) : (1 - b), and what swings at 45 degrees is turned into
// circular light by the phase by which y is ahead of x, c = cos and d = sin of it times the share that stays coherent,
// 2 sqrt(X Y) / (X + Y). All in units of the mean of X and Y.
Mueller phase_plate(vec3 axis, Spectrum b, Spectrum c, Spectrum d) {
    Mueller m = depolarizing();
    m.from = m.to = axis;
    m.m[1] = m.m[4] = b;
    m.m[5] = Spectrum(1);
    m.m[10] = m.m[15] = c;
    m.m[11] = -d, m.m[14] = d;
    return m;
}

// Of light that nothing happens to.
Mueller passing(vec3 direction) { return phase_plate(stokes_axis(direction), Spectrum(0), Spectrum(1), Spectrum(0)); }

// The same with the rest, a share of 1 - `part`, depolarized.
Mueller partly(Mueller m, Spectrum part) {
    for (int i = 1; i < 16; ++i) m.m[i] *= part;
    return m;
}

// The first axis at a facet of normal h, where light goes along w: across the plane of incidence, any across the normal where light
// comes along it.
vec3 facet_axis(vec3 w, vec3 h) {
    vec3 s = cross(h, w);
    float l = dot(s, s);
    return l > 1e-12 ? s * inversesqrt(l) : stokes_axis(h);
}

// M applied to a Stokes vector (1, p), or (`transposed`) a row (1, p) to M: what becomes of p, and of S0, which is multiplied by
// the result, 0 to 2.
Spectrum apply_mueller(inout Polarization p, Mueller m, bool transposed) {
    Spectrum s[4];
    for (int i = 0; i < 4; ++i) {
        ivec4 k = transposed ? ivec4(0, 4, 8, 12) + i : ivec4(0, 1, 2, 3) + 4 * i;
        s[i] = m.m[k.x] + m.m[k.y] * p.s1 + m.m[k.z] * p.s2 + m.m[k.w] * p.s3;
    }
    Spectrum total = max(s[0], Spectrum(0));
    Spectrum inverse = mix(1.0 / total, Spectrum(0), lessThanEqual(total, Spectrum(1e-20)));
    p = Polarization(s[1] * inverse, s[2] * inverse, s[3] * inverse);
    return total / m.m[0];
}

// The product of a row and a Stokes vector over that of their first elements, in one frame.
Spectrum meet(Polarization row, Polarization light) {
    return max(1.0 + row.s1 * light.s1 + row.s2 * light.s2 + row.s3 * light.s3, Spectrum(0));
}
