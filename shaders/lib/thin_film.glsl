// What a thin film reflects: all reflections between its faces summed with their phases (Airy 1833; by admittances, Macleod
// 2010, "Thin-Film Optical Filters", section 2.6), for unpolarized light. Used by surfaces/thin_film.glsl and principled.glsl.
//
// Of paths that carry wavelengths it is the reflectance at each. Colours have it integrated over the channels' sensitivities
// under D65, by 16 bands even in wavenumber: within a band the fringes, as cosines of the phase, are integrated in closed form,
// and the rest is taken as even; thick films so show no fringes (the aim of Belcour & Barla 2017, whose Fourier series
// of whole channels converges slowly where films are thin or reflect much).
#include "lib/constants.glsl"
#include "features/spectrum.glsl"

vec2 complex_quotient(vec2 a, vec2 b) {
    return vec2(dot(a, b), a.y * b.x - a.x * b.y) / max(dot(b, b), 1e-30);
}
// The root with imaginary part <= 0, for a with such: waves exp(i omega t) that fade away from the surface.
vec2 complex_root(vec2 a) {
    float l = length(a);
    return vec2(sqrt(max(0.5 * (l + a.x), 0.0)), -sqrt(max(0.5 * (l - a.x), 0.0)));
}

// |r|² of a film on a base of admittance `base`, seen from one of admittance `near`: with the film's phase thickness delta,
// B = cos + (i sin / film) base, C = cos base + i sin film. c = cos(delta), p = sin(delta) / film, q = sin(delta) film: all real,
// also where the wave in the film fades.
float film_reflected(float near, vec2 base, float c, float p, float q) {
    vec2 b = near * vec2(c - p * base.y, p * base.x);
    vec2 d = vec2(c * base.x, c * base.y + q);
    vec2 minus = b - d, plus = b + d;
    return dot(minus, minus) / max(dot(plus, plus), 1e-30);
}

// At one wavelength. cos_o >= 0 in the medium of index n; film of index `film` and thickness in nm; base of index eta - i k.
// Fringes whose phase varies by 2 `phase_range` delta over a band are averaged over it.
float film_reflectance(float cos_o, float n, float film, float thickness, vec2 base, float nm, float phase_range) {
    float sine2 = n * n * (1.0 - cos_o) * (1.0 + cos_o);
    float q1 = max(n * min(cos_o, 1.0), 1e-6);
    float film2 = film * film, square2 = film2 - sine2;
    float q2 = max(sqrt(abs(square2)), 1e-4);
    bool fades = square2 < 0.0;
    square2 = fades ? -q2 * q2 : q2 * q2;
    vec2 permittivity3 = vec2((base.x - base.y) * (base.x + base.y), -2.0 * base.x * base.y);
    vec2 q3 = complex_root(permittivity3 - vec2(sine2, 0));
    vec2 admittance3 = complex_quotient(permittivity3, q3);  // of p; that of s is q3
    float delta = 2.0 * PI * thickness * q2 / nm;
    float c, s;
    if (fades)
        c = 1.0, s = tanh(min(delta, 20.0));  // of -i delta, over cosh(delta)
    else
        c = cos(delta), s = sin(delta);
    float p = s / q2;  // of s; the rest follows from the square of the film's admittance
    vec2 near = vec2(q1, n * n / q1);
    vec2 reflected = vec2(film_reflected(near.x, q3, c, p, p * square2),
                          film_reflected(near.y, admittance3, c, p * square2 / film2, p * film2));
    if (phase_range > 0.0 && !fades) {
        // Mean over the phase, of each polarization: R12 + (1 - R12)² R23 / (1 - R12 R23).
        vec2 middle = vec2(q2, film2 / q2), r12 = (near - middle) / (near + middle);
        r12 *= r12;
        vec2 r23 = vec2(film_reflected(middle.x, q3, 1.0, 0.0, 0.0), film_reflected(middle.y, admittance3, 1.0, 0.0, 0.0));
        vec2 mean = r12 + (1.0 - r12) * (1.0 - r12) * r23 / max(1.0 - r12 * r23, 1e-6);
        float half_range = max(delta * phase_range, 1e-3);
        reflected = mix(mean, reflected, sin(half_range) / half_range);
    }
    return min(0.5 * (reflected.x + reflected.y), 1.0);
}
