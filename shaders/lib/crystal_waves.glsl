// Plane waves in isotropic media and in uniaxial crystals, exp(i (omega t - K · r)) with K in units of the vacuum's wave number.
//
// A crystal carries two waves, each polarized in one way: the ordinary one, of index `ordinary`, whose E is across the axis; and the
// extraordinary one, with (K · c)² / no² + |K x c|² / ne² = 1 for the unit axis c, whose energy goes along another direction than K,
//   s ~ K / ne² + (1 / no² - 1 / ne²) (K · c) c        back: K = (ne² s + (no² - ne²) (s · c) c) / sqrt(ne² sin² + no² cos²)
// by the angle between s and c. Rays go along s (Weidlich & Wilkie 2008, "Realistic Rendering of Birefringency in Uniaxial
// Crystals", section 3).
#include "lib/complex.glsl"
#include "lib/constants.glsl"
#include "lib/frames.glsl"

struct Crystal {
    float ordinary, extraordinary;  // refractive indices; the same in an isotropic medium
    vec3 axis;                      // optic axis, unit; 0 = isotropic
};

const uint MODE_NONE = 0u;  // of rays in isotropic media
const uint MODE_ORDINARY = 1u;
const uint MODE_EXTRAORDINARY = 2u;

Crystal isotropic_medium(float ior) { return Crystal(ior, ior, vec3(0)); }
bool is_crystal(Crystal m) { return m.axis != vec3(0); }

// sqrt(ne² sin² + no² cos²) by the cosine of the angle between ray and axis: the optical path per metre of an extraordinary ray.
float ray_index(Crystal m, float cosine) {
    float c2 = cosine * cosine;
    return sqrt(square(m.extraordinary) * max(0.0, 1.0 - c2) + square(m.ordinary) * c2);
}

// Of the wave whose energy goes along a unit direction.
vec3 wave_vector(Crystal m, uint mode, vec3 ray) {
    if (mode != MODE_EXTRAORDINARY) return m.ordinary * ray;
    float cosine = dot(ray, m.axis), no2 = square(m.ordinary), ne2 = square(m.extraordinary);
    return (ne2 * ray + (no2 - ne2) * cosine * m.axis) / ray_index(m, cosine);
}

// n², of a wave's phase space: dA d²K_t = n² cos dA dOmega for rays, which refraction keeps, so that radiance over n² stays the same
// along a ray. One over the Gaussian curvature of the surface of all K of that wave.
float squared_index(Crystal m, uint mode, vec3 ray) {
    float no2 = square(m.ordinary);
    if (mode != MODE_EXTRAORDINARY) return no2;
    float ne2 = square(m.extraordinary);
    return no2 * square(ne2 / square(ray_index(m, dot(ray, m.axis))));
}

struct ComplexVector { vec3 re, im; };
ComplexVector cross_of(ComplexVector a, ComplexVector b) {
    return ComplexVector(cross(a.re, b.re) - cross(a.im, b.im), cross(a.re, b.im) + cross(a.im, b.re));
}

// A wave at a plane z = 0, in a frame whose x is the part of K along the plane: K = (kx, 0, q).
struct Wave {
    vec2 fields[4];       // Ex, Ey, Hx, Hy, complex; they carry unit power through the plane, if any
    bool travels;         // else it dies away from the plane and carries none
    vec3 ray;             // where the energy goes, unit
    float squared_index;
};

// The wave that goes on to +z (`sense` 1) or -z (-1), or dies away that way; of isotropic media with E along y (first) or in the
// plane of incidence, along K x y: s and p with Verdet's signs (lib/stokes.glsl). The axis is in the frame of the plane.
Wave wave_at_plane(Crystal m, float kx, float sense, bool second) {
    float no2 = square(m.ordinary), ne2 = square(m.extraordinary);
    bool extraordinary = is_crystal(m) && second;
    vec3 c = m.axis;
    // a q² + 2 b q + d = 0
    float anisotropy = extraordinary ? ne2 / no2 - 1.0 : 0.0;
    float a = 1.0 + anisotropy * c.z * c.z, b = anisotropy * kx * c.x * c.z;
    float d = kx * kx * (1.0 + anisotropy * c.x * c.x) - (extraordinary ? ne2 : no2);
    float discriminant = b * b - a * d;
    Wave w;
    w.travels = discriminant > 0.0;
    vec2 q = (vec2(-b, 0.0) + (w.travels ? vec2(sense, 0.0) : vec2(0.0, -sense)) * sqrt(abs(discriminant))) / a;
    ComplexVector k = ComplexVector(vec3(kx, 0.0, q.x), vec3(0.0, 0.0, q.y)), e, axis = ComplexVector(c, vec3(0));
    ComplexVector across = cross_of(k, axis);
    // Along the axis both waves are the same, and any two polarizations will do.
    if (dot(across.re, across.re) + dot(across.im, across.im) > 1e-8 * no2) {
        e = across;
        if (second) {
            e = cross_of(k, across);
            float less = 1.0 / ne2 - 1.0 / no2;
            e = ComplexVector(e.re / no2 + less * dot(e.re, c) * c, e.im / no2 + less * dot(e.im, c) * c);
        }
    } else {
        e = ComplexVector(vec3(0, 1, 0), vec3(0));
        if (second) e = cross_of(k, e);
    }
    ComplexVector h = cross_of(k, e);
    vec2 fields[4] = vec2[4](vec2(e.re.x, e.im.x), vec2(e.re.y, e.im.y), vec2(h.re.x, h.im.x), vec2(h.re.y, h.im.y));
    float power = abs(dot(fields[0], fields[3]) - dot(fields[1], fields[2])), size = 0.0;
    for (int i = 0; i < 4; ++i) size += dot(fields[i], fields[i]);
    float scale = inversesqrt(max(w.travels ? power : size, 1e-30));
    for (int i = 0; i < 4; ++i) w.fields[i] = fields[i] * scale;
    w.ray = k.re;
    if (extraordinary) w.ray = k.re / ne2 + (1.0 / no2 - 1.0 / ne2) * dot(k.re, c) * c;
    w.ray = normalize(w.ray);
    w.squared_index = squared_index(m, extraordinary ? MODE_EXTRAORDINARY : MODE_ORDINARY, w.ray);
    return w;
}
