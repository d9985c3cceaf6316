// A pane: two smooth parallel interfaces, all reflections between them summed. The pane itself has no
// thickness, so what it lets through goes straight on: R' = R + T² R + T² R³ + … = 2 R / (1 + R),
// T' = 1 - R', of s and p each: a reflection within meets light that the faces have polarized. Lossless.
//
// Example:
//     {"materials": [{"name": "glass bubble", "extensions": {"ETD_optics": {
//         "surface": {"class": "thin_dielectric", "ior": 1.5}}}}]}
#include "lib/fresnel.glsl"

struct ThinDielectric {
    float ior;  //: 1.5 in (0, inf). Refractive index of the pane.
};

ThinDielectric thin_dielectric_resolve(ThinDielectric r, SurfaceContext c) { return r; }

float thin_dielectric_reflectance(ThinDielectric r, SurfaceContext c, vec3 wo) {
    vec2 f = fresnel_dielectric_parts(wo.z, r.ior / (wo.z < 0.0 ? c.ior_below : c.ior_above));
    f = 2.0 * f / (1.0 + f);
    return min(0.5 * (f.x + f.y), 1.0);
}

SurfacePair thin_dielectric_evaluate(ThinDielectric r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }

BsdfSample thin_dielectric_sample(ThinDielectric r, SurfaceContext c, vec3 wo, vec3 u) {
    float f = thin_dielectric_reflectance(r, c, wo);
    bool reflects = u.z < f;
    return BsdfSample(reflects ? vec3(-wo.xy, wo.z) : -wo, Spectrum(1), reflects ? f : 1.0 - f,
                      reflects ? EVENT_REFLECT | EVENT_DELTA : EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
}

// The echoes add up incoherently, each with its own matrix: light at 45 degrees is turned by all reflections within.
Mueller thin_dielectric_mueller(ThinDielectric r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    float eta = r.ior / (from.z < 0.0 ? c.ior_below : c.ior_above);
    float cosine = clamp(abs(from.z), 1e-7, 1.0);
    float g2 = (eta - 1.0) * (eta + 1.0) + cosine * cosine;
    vec3 axis = facet_axis(to, vec3(0, 0, 1));
    bool reflects = from.z * to.z > 0.0;
    if (g2 <= 0.0) return fresnel_dielectric_mueller(axis, cosine, eta, reflects);
    float g = sqrt(g2);
    vec2 amplitudes = vec2((cosine - g) / (cosine + g), (eta * eta * cosine - g) / (eta * eta * cosine + g));
    vec2 reflected = amplitudes * amplitudes;
    float turned = amplitudes.x * amplitudes.y;  // by a reflection
    float passed = (1.0 - reflected.x) * (1.0 - reflected.y) / (1.0 - turned * turned);
    vec2 parts = reflects ? 2.0 * reflected / (1.0 + reflected) : (1.0 - reflected) / (1.0 + reflected);
    float kept = reflects ? turned * (1.0 + passed) : passed;
    float inverse = 1.0 / max(parts.x + parts.y, 1e-30);
    return phase_plate(axis, Spectrum((parts.x - parts.y) * inverse), Spectrum(2.0 * kept * inverse), Spectrum(0));
}

Spectrum thin_dielectric_transparency(ThinDielectric r, SurfaceContext c, vec3 wo) {
    return Spectrum(1.0 - thin_dielectric_reflectance(r, c, wo));
}

bool thin_dielectric_is_delta(ThinDielectric r, SurfaceContext c) { return true; }
bool thin_dielectric_is_opaque(ThinDielectric r, SurfaceContext c) { return false; }
