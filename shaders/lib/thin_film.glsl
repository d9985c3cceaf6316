// What a thin film reflects: all reflections between its faces summed with their phases (Airy 1833; by admittances, Macleod
// 2010, "Thin-Film Optical Filters", section 2.6), for unpolarized light and for all other. Used by surfaces/thin_film.glsl and
// principled.glsl.
//
// Of paths that carry wavelengths it is the reflectance at each. Colours have it integrated over the channels' sensitivities
// under D65, by 16 bands even in wavenumber: within a band the fringes, as cosines of the phase, are integrated in closed form,
// and the rest is taken as even; thick films so show no fringes (the aim of Belcour & Barla 2017, whose Fourier series
// of whole channels converges slowly where films are thin or reflect much).
#include "lib/complex.glsl"
#include "lib/constants.glsl"
#include "features/spectrum.glsl"

// A film as a wave meets it: admittances (Macleod) of s and p above it, in it and below it. c = cos(delta) of the phase thickness
// delta, and sin(delta) over and times the film's admittance, are real, also where the wave in the film fades.
struct FilmStack {
    vec2 near, film;
    vec2 base_s, base_p;   // complex
    float c;
    vec2 quotient, product;
    float delta;
    bool fades;
};

// At one wavelength. cos_o >= 0 in the medium of index n; film of index `film` and thickness in nm; base of index eta - i k.
FilmStack film_stack(float cos_o, float n, float film, float thickness, vec2 base, float nm) {
    FilmStack stack;
    float sine2 = n * n * (1.0 - cos_o) * (1.0 + cos_o);
    float q1 = max(n * min(cos_o, 1.0), 1e-6);
    float film2 = film * film, square2 = film2 - sine2;
    float q2 = max(sqrt(abs(square2)), 1e-4);
    stack.fades = square2 < 0.0;
    square2 = stack.fades ? -q2 * q2 : q2 * q2;
    vec2 permittivity3 = vec2((base.x - base.y) * (base.x + base.y), -2.0 * base.x * base.y);
    stack.base_s = complex_root(permittivity3 - vec2(sine2, 0));
    stack.base_p = complex_quotient(permittivity3, stack.base_s);
    stack.delta = 2.0 * PI * thickness * q2 / nm;
    float s;
    if (stack.fades)
        stack.c = 1.0, s = tanh(min(stack.delta, 20.0));  // of -i delta, over cosh(delta)
    else
        stack.c = cos(stack.delta), s = sin(stack.delta);
    float p = s / q2;  // of s; the rest follows from the square of the film's admittance
    stack.quotient = vec2(p, p * square2 / film2), stack.product = vec2(p * square2, p * film2);
    stack.near = vec2(q1, n * n / q1), stack.film = vec2(q2, film2 / q2);
    return stack;
}

// near B - C and near B + C of a film on a base, with B = cos + (i sin / film) base, C = cos base + i sin film: the ratio is what
// it reflects of the amplitude.
void film_fields(float near, vec2 base, float c, float p, float q, out vec2 minus, out vec2 plus) {
    vec2 b = near * vec2(c - p * base.y, p * base.x);
    vec2 d = vec2(c * base.x, c * base.y + q);
    minus = b - d, plus = b + d;
}

// |r|² of that.
float film_reflected(float near, vec2 base, float c, float p, float q) {
    vec2 minus, plus;
    film_fields(near, base, c, p, q, minus, plus);
    return dot(minus, minus) / max(dot(plus, plus), 1e-30);
}

// Fringes whose phase varies by 2 `phase_range` delta over a band are averaged over it: so much of them is left.
float film_fringes(FilmStack stack, float phase_range) {
    float half_range = max(stack.delta * phase_range, 1e-3);
    return stack.fades ? 1.0 : sin(half_range) / half_range;
}

// For unpolarized light; arguments of film_stack().
float film_reflectance(float cos_o, float n, float film, float thickness, vec2 base, float nm, float phase_range) {
    FilmStack stack = film_stack(cos_o, n, film, thickness, base, nm);
    vec2 reflected = vec2(film_reflected(stack.near.x, stack.base_s, stack.c, stack.quotient.x, stack.product.x),
                          film_reflected(stack.near.y, stack.base_p, stack.c, stack.quotient.y, stack.product.y));
    if (phase_range > 0.0 && !stack.fades) {
        // Mean over the phase, of each polarization: R12 + (1 - R12)² R23 / (1 - R12 R23).
        vec2 r12 = (stack.near - stack.film) / (stack.near + stack.film);
        r12 *= r12;
        vec2 r23 = vec2(film_reflected(stack.film.x, stack.base_s, 1.0, 0.0, 0.0),
                        film_reflected(stack.film.y, stack.base_p, 1.0, 0.0, 0.0));
        vec2 mean = r12 + (1.0 - r12) * (1.0 - r12) * r23 / max(1.0 - r12 * r23, 1e-6);
        reflected = mix(mean, reflected, film_fringes(stack, phase_range));
    }
    return min(0.5 * (reflected.x + reflected.y), 1.0);
}

// Of light that a film reflects or lets through: |s|², |p|² and p conj(s), complex, of its amplitudes, in Verdet's signs (r_p is
// less the admittances' one).
vec4 film_moments(FilmStack stack, bool reflects, float phase_range) {
    vec2 minus_s, plus_s, minus_p, plus_p;
    film_fields(stack.near.x, stack.base_s, stack.c, stack.quotient.x, stack.product.x, minus_s, plus_s);
    film_fields(stack.near.y, stack.base_p, stack.c, stack.quotient.y, stack.product.y, minus_p, plus_p);
    vec2 let_s = vec2(2.0 * sqrt(stack.near.x * stack.base_s.x), 0), let_p = vec2(2.0 * sqrt(stack.near.y * stack.base_p.x), 0);
    vec2 s = complex_quotient(reflects ? minus_s : let_s, plus_s), p = complex_quotient(reflects ? -minus_p : let_p, plus_p);
    vec4 moments = vec4(dot(s, s), dot(p, p), complex_product(p, conjugate(s)));
    if (phase_range > 0.0 && !stack.fades) {
        // With a and b for the amplitudes at both faces: r = a + (1 - a²) (b e - a b² e² + ...), and what passes is
        // sqrt(1 - a²) t (1 - a b e + ...). Means of products are those of terms with the same power of the phase factor e.
        vec2 a = (stack.near - stack.film) / (stack.near + stack.film) * vec2(1, -1);
        vec2 below_s = vec2(stack.film.x, 0) + stack.base_s, below_p = vec2(stack.film.y, 0) + stack.base_p;
        vec2 b_s = complex_quotient(vec2(stack.film.x - stack.base_s.x, -stack.base_s.y), below_s);
        vec2 b_p = -complex_quotient(vec2(stack.film.y - stack.base_p.x, -stack.base_p.y), below_p);
        vec2 t_s = complex_quotient(vec2(2.0 * sqrt(stack.film.x * stack.base_s.x), 0), below_s);
        vec2 t_p = complex_quotient(vec2(2.0 * sqrt(stack.film.y * stack.base_p.x), 0), below_p);
        vec2 left = 1.0 - a * a;
        vec2 bs = vec2(dot(b_s, b_s), 0), bp = vec2(dot(b_p, b_p), 0), both = complex_product(b_p, conjugate(b_s));
        vec2 ts = vec2(dot(t_s, t_s), 0), tp = vec2(dot(t_p, t_p), 0), through = complex_product(t_p, conjugate(t_s));
        vec3 aa = vec3(a.x * a.x, a.y * a.y, a.x * a.y);
        vec3 factors = vec3(left.x, left.y, sqrt(left.x * left.y));
        vec2 mean_s, mean_p, mean;
        if (reflects) {
            factors *= factors;
            mean_s = complex_quotient(bs, vec2(1, 0) - aa.x * bs), mean_p = complex_quotient(bp, vec2(1, 0) - aa.y * bp);
            mean = complex_quotient(both, vec2(1, 0) - aa.z * both);
        } else {
            mean_s = complex_quotient(ts, vec2(1, 0) - aa.x * bs), mean_p = complex_quotient(tp, vec2(1, 0) - aa.y * bp);
            mean = complex_quotient(through, vec2(1, 0) - aa.z * both);
            aa = vec3(0);
        }
        vec4 means = vec4(aa.x + factors.x * mean_s.x, aa.y + factors.y * mean_p.x, vec2(aa.z, 0) + factors.z * mean);
        moments = mix(means, moments, film_fringes(stack, phase_range));
    }
    return moments;
}
