// Films on the facets of the class `principled`, whose reflection is that of interference (lib/thin_film.glsl).
#include "features/spectrum.glsl"

struct PrincipledFilm {
    float part;       // of the surface that has one
    float index;
    float thickness;  // nm
    Spectrum dielectric_index, metal_index;  // of what is below, in air
};

#ifndef ABSENT_principled_iridescence
#include "features/thin_film_spectra.glsl"

// Real index of what reflects f0 at normal incidence in air.
Spectrum index_of_reflection(Spectrum f0) {
    Spectrum root = sqrt(clamp(f0, Spectrum(0), Spectrum(0.9999)));
    return (1.0 + root) / (1.0 - root);
}

// On a dielectric that reflects f0 at normal incidence, and a metal of this colour.
PrincipledFilm principled_film(Principled r, Spectrum f0, Spectrum color) {
    return PrincipledFilm(clamp(r.iridescence, 0.0, 1.0), r.iridescence_ior, r.iridescence_thickness_maximum,
                          index_of_reflection(f0), index_of_reflection(color));
}

// With the film: what principled_bound() and its average are, of facets of this greatest width (0: smooth).
void bound_film(PrincipledFilm film, float f90, float mu, float widest, inout float bound, inout float average) {
    if (!(film.part > 0.0)) return;
    // The most that a film reflects at normal incidence, and towards grazing angles more than any film of index 1 to
    // 2.5 on bases of 1 to 3; what rough facets add is less than the last term.
    float a = (film.index - 1.0) / (film.index + 1.0), b = 0.0;
    Spectrum below = abs((film.dielectric_index - film.index) / (film.dielectric_index + film.index));
    for (uint i = 0u; i < LANES; ++i) b = max(b, below[i]);
    float most = square((a + b) / (1.0 + a * b)), tail = 0.04 + 0.1 * widest;
    float grazing = most + (1.0 - most) * min(pow(max(1.0 - mu, 1e-7), 1.5) + tail, 0.999);
    bound = mix(bound, f90 * grazing, film.part);
    average = mix(average, f90 * (most + (1.0 - most) * 2.0 / (2.5 * 3.5)), film.part);
}

// What facets of metal, of a dielectric that is diffuse below and of one that lets light through reflect, and what the last lets
// pass. `parts`: of the surface that are those three; `near` and `eta` of the last, unless it is thin.
void reflect_by_film(PrincipledFilm film, vec3 parts, bool thin, float near, float eta, float f90, float cos_o,
                     inout Spectrum metal, inout Spectrum opaque, inout Spectrum transmitter, inout Spectrum passes) {
    if (!(film.part > 0.0)) return;
    for (int i = 0; i < 3; ++i) {  // a loop, so that the code stands once
        bool solid = i == 2 && !thin;
        if (!((i == 0 ? parts.x : i == 1 ? parts.y : parts.z) > 0.0)) continue;
        Spectrum base = i == 0 ? film.metal_index : solid ? Spectrum(near * eta) : film.dielectric_index;
        Spectrum reflected =
            thin_film_reflectance(cos_o, solid ? near : 1.0, Spectrum(film.index), film.thickness, base, Spectrum(0));
        if (i == 0) metal = mix(metal, reflected, film.part);
        // Beyond the critical angle of a solid nothing else takes what is not reflected.
        bool total = solid && (1.0 - cos_o) * (1.0 + cos_o) >= eta * eta;
        if (i == 1) opaque = mix(opaque, reflected * f90, film.part);
        if (i == 2 && !total) {
            transmitter = mix(transmitter, reflected * f90, film.part);
            passes = mix(passes, 1.0 - reflected * f90, film.part);
        }
    }
}
// What a film on the facets, of metal for this part, does to the polarization of what they reflect or let through.
Mueller polarize_by_film(PrincipledFilm film, Mueller m, Spectrum metal, bool thin, float near, float eta, float cos_o,
                         bool reflects) {
    if (!(film.part > 0.0)) return m;
    bool solid = !reflects && !thin;
    Spectrum base = solid ? Spectrum(near * eta) : film.dielectric_index;
    for (int i = 0; i < 2; ++i) {  // a loop, so that the code stands once
        bool of_metal = i == 1;
        if (of_metal && is_black(metal)) break;
        Mueller with_film = thin_film_mueller(m.from, cos_o, solid ? near : 1.0, Spectrum(film.index), film.thickness,
                                              of_metal ? film.metal_index : base, Spectrum(0), reflects);
        m = mixed(m, with_film, film.part * (of_metal ? metal : Spectrum(1)));
    }
    return m;
}
#else
#define polarize_by_film(film, m, metal, thin, near, eta, cos_o, reflects) m
#define principled_film(r, f0, color) PrincipledFilm(0.0, 1.0, 0.0, Spectrum(1), Spectrum(1))
#define bound_film(film, f90, mu, widest, bound, average)
#define reflect_by_film(film, parts, thin, near, eta, f90, cos_o, metal, opaque, transmitter, passes)
#endif
