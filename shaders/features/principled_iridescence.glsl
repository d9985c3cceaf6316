// Films on the facets of the class `principled`, whose reflection is that of interference (lib/thin_film.glsl).
#ifndef ABSENT_principled_iridescence
#include "features/thin_film_spectra.glsl"

// Real index of what reflects f0 at normal incidence in air.
Spectrum index_of_reflection(Spectrum f0) {
    Spectrum root = sqrt(clamp(f0, Spectrum(0), Spectrum(0.9999)));
    return (1.0 + root) / (1.0 - root);
}

void set_film(inout PrincipledMaterial m, Principled r) {
    m.iridescence = clamp(r.iridescence, 0.0, 1.0);
    m.film = r.iridescence_ior, m.film_thickness = r.iridescence_thickness_maximum;
    m.dielectric_index = index_of_reflection(m.f0 / max(m.f90, 1e-6));
    m.metal_index = index_of_reflection(m.color);
}

// With the film: what principled_bound() and its average are.
void bound_film(PrincipledMaterial m, float mu, float widest, inout float bound, inout float average) {
    if (!(m.iridescence > 0.0)) return;
    // The most that a film reflects at normal incidence, and towards grazing angles more than any film of index 1 to
    // 2.5 on bases of 1 to 3; what rough facets add is less than the last term.
    float a = (m.film - 1.0) / (m.film + 1.0), b = 0.0;
    for (int i = 0; i < m.f0.length(); ++i)
        b = max(b, abs((m.dielectric_index[i] - m.film) / (m.dielectric_index[i] + m.film)));
    float most = square((a + b) / (1.0 + a * b)), tail = m.smooth_facets ? 0.04 : 0.04 + 0.1 * widest;
    float film = most + (1.0 - most) * min(pow(max(1.0 - mu, 1e-7), 1.5) + tail, 0.999);
    bound = mix(bound, m.f90 * film, m.iridescence);
    average = mix(average, m.f90 * (most + (1.0 - most) * 2.0 / (2.5 * 3.5)), m.iridescence);
}

// What facets of metal, of the opaque part and of the transmitting part reflect, and what the last lets pass.
void reflect_by_film(PrincipledMaterial m, float cos_o, inout Spectrum metal, inout Spectrum opaque, inout Spectrum transmitter,
                     inout Spectrum passes) {
    if (!(m.iridescence > 0.0)) return;
    for (int i = 0; i < 3; ++i) {  // a loop, so that the code stands once
        bool solid = i == 2 && !m.thin;
        if (!((i == 0 ? m.metal : i == 1 ? m.opaque : m.transmitter) > 0.0)) continue;
        float near = solid ? m.near : 1.0;
        Spectrum base = i == 0 ? m.metal_index : solid ? Spectrum(m.near * m.eta) : m.dielectric_index;
        Spectrum film = thin_film_reflectance(cos_o, near, Spectrum(m.film), m.film_thickness, base, Spectrum(0));
        if (i == 0) metal = mix(metal, film, m.iridescence);
        // Beyond the critical angle of a solid nothing else takes what is not reflected.
        bool total = solid && (1.0 - cos_o) * (1.0 + cos_o) >= m.eta * m.eta;
        if (i == 1) opaque = mix(opaque, film * m.f90, m.iridescence);
        if (i == 2 && !total) {
            transmitter = mix(transmitter, film * m.f90, m.iridescence);
            passes = mix(passes, 1.0 - film * m.f90, m.iridescence);
        }
    }
}
#else
void set_film(inout PrincipledMaterial m, Principled r) {}
void bound_film(PrincipledMaterial m, float mu, float widest, inout float bound, inout float average) {}
void reflect_by_film(PrincipledMaterial m, float cos_o, inout Spectrum metal, inout Spectrum opaque, inout Spectrum transmitter,
                     inout Spectrum passes) {}
#endif
