// What a thin film reflects (lib/thin_film.glsl) of the wavelengths of a path, or of its colour.
#include "features/spectrum.glsl"
#include "lib/stokes.glsl"
#include "lib/thin_film.glsl"

#if SPECTRAL
Spectrum thin_film_reflectance(float cos_o, float n, Spectrum film, float thickness, Spectrum eta, Spectrum k) {
    vec4 nm = wavelengths[batch_pass].nm;
    Spectrum result = Spectrum(0);
    // The driver does not know that it is four, and so leaves the loop as it is: unrolled, its code takes minutes to compile.
    uint count = nm.x > 0.0 ? 4u : 0u;
    for (uint i = 0u; i < count; ++i) {
        float r = film_reflectance(cos_o, n, film[i], thickness, vec2(eta[i], k[i]), nm[i], 0.0);
        result = mix(result, Spectrum(r), equal(uvec4(i), uvec4(0, 1, 2, 3)));
    }
    return result;
}

// Sums of film_moments(): |s|², |p|², and both parts of p conj(s).
void thin_film_moments(float cos_o, float n, Spectrum film, float thickness, Spectrum eta, Spectrum k, bool reflects,
                       out Spectrum m[4]) {
    vec4 nm = wavelengths[batch_pass].nm;
    uint count = nm.x > 0.0 ? 4u : 0u;  // as above
    m[0] = m[1] = m[2] = m[3] = Spectrum(0);
    for (uint i = 0u; i < count; ++i) {
        vec4 moments = film_moments(film_stack(cos_o, n, film[i], thickness, vec2(eta[i], k[i]), nm[i]), reflects, 0.0);
        vec4 lane = mix(vec4(0), vec4(1), equal(uvec4(i), uvec4(0, 1, 2, 3)));
        for (int j = 0; j < 4; ++j) m[j] += lane * moments[j];
    }
}

#else
// Centres of 16 bands of 395 to 710 nm, and what light of D65 in each adds to the channels.
const uint FILM_BANDS = 16u;
const float FILM_BAND_WIDTH = 0.07019968;  // 1/um
const vec3 FILM_BAND_WEIGHTS[16] = vec3[16](
    vec3(0.01586, -0.00171, -0.00011), vec3(0.10837, -0.01093, -0.00083), vec3(0.36140, -0.02572, -0.00411),
    vec3(0.53390, 0.01914, -0.01312), vec3(0.32718, 0.15258, -0.02545), vec3(0.05587, 0.27803, -0.03479),
    vec3(-0.12527, 0.29701, -0.02868), vec3(-0.16876, 0.22259, -0.00341), vec3(-0.10593, 0.10486, 0.04387),
    vec3(-0.06100, 0.04293, 0.14022), vec3(-0.01322, -0.00362, 0.25346), vec3(0.01946, -0.02583, 0.28701),
    vec3(0.02923, -0.02871, 0.23579), vec3(0.01611, -0.01465, 0.10775), vec3(0.00533, -0.00470, 0.03338),
    vec3(0.00149, -0.00128, 0.00902));

// A channel's value stands for 630, 550 and 465 nm; linear in between.
float film_value_at(Spectrum rgb, float nm) {
    return nm > 550.0 ? mix(rgb.g, rgb.r, min((nm - 550.0) / 80.0, 1.0)) : mix(rgb.g, rgb.b, min((550.0 - nm) / 85.0, 1.0));
}

Spectrum thin_film_reflectance(float cos_o, float n, Spectrum film, float thickness, Spectrum eta, Spectrum k) {
    vec3 sum = vec3(0);
    for (uint i = 0u; i < FILM_BANDS; ++i) {
        float wavenumber = 1.0 / 0.710 + (float(i) + 0.5) * FILM_BAND_WIDTH;
        float nm = 1000.0 / wavenumber;
        vec2 base = vec2(film_value_at(eta, nm), film_value_at(k, nm));
        // delta is proportional to the wavenumber, and R varies with 2 delta.
        sum += FILM_BAND_WEIGHTS[i] * film_reflectance(cos_o, n, film_value_at(film, nm), thickness, base, nm,
                                                       FILM_BAND_WIDTH / wavenumber);
    }
    return clamp(sum, vec3(0), vec3(1));
}

void thin_film_moments(float cos_o, float n, Spectrum film, float thickness, Spectrum eta, Spectrum k, bool reflects,
                       out Spectrum m[4]) {
    m[0] = m[1] = m[2] = m[3] = Spectrum(0);
    for (uint i = 0u; i < FILM_BANDS; ++i) {
        float wavenumber = 1.0 / 0.710 + (float(i) + 0.5) * FILM_BAND_WIDTH;
        float nm = 1000.0 / wavenumber;
        vec2 base = vec2(film_value_at(eta, nm), film_value_at(k, nm));
        FilmStack stack = film_stack(cos_o, n, film_value_at(film, nm), thickness, base, nm);
        vec4 moments = film_moments(stack, reflects, FILM_BAND_WIDTH / wavenumber);
        for (int j = 0; j < 4; ++j) m[j] += FILM_BAND_WEIGHTS[i] * moments[j];
    }
}
#endif

// What a film does to polarization; `axis`: across the plane of incidence. Channels have negative weights for some wavelengths:
// what would be more polarization than light is cut.
Mueller thin_film_mueller(vec3 axis, float cos_o, float n, Spectrum film, float thickness, Spectrum eta, Spectrum k,
                          bool reflects) {
    Spectrum m[4];
    thin_film_moments(max(cos_o, 0.0), n, film, thickness, eta, k, reflects, m);
    Spectrum inverse = 1.0 / max(m[0] + m[1], Spectrum(1e-30));
    Spectrum b = clamp((m[0] - m[1]) * inverse, Spectrum(-1), Spectrum(1));
    Spectrum c = 2.0 * m[2] * inverse, d = 2.0 * m[3] * inverse;
    Spectrum most = max(1.0 - b * b, Spectrum(0)), kept = min(sqrt(most / max(c * c + d * d, Spectrum(1e-30))), Spectrum(1));
    return phase_plate(axis, b, c * kept, d * kept);
}
