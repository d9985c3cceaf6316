// A smooth interface between two media with an ideal antireflection film: whatever can be refracted is, by Snell's law, as it was
// polarized; the rest is totally reflected, as at a `dielectric`. So sequential lens design has it. The media say the refractive
// indices.
//
// Example:
//     {"materials": [{"name": "coated lens", "extensions": {"ETD_optics": {
//         "surface": {"class": "antireflective"}, "inside": "glass"}}}],
//      "extensions": {"ETD_optics": {"media": [{"name": "glass", "class": "homogeneous", "ior": {"name": "BK7 ior"}}]}}}
#include "lib/fresnel.glsl"

struct Antireflective {
    uint unused;  // a record holds at least one member
};

Antireflective antireflective_resolve(Antireflective r, SurfaceContext c) { return r; }

SurfacePair antireflective_evaluate(Antireflective r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }

float antireflective_eta(SurfaceContext c, float side) {
    return side < 0.0 ? c.ior_above / c.ior_below : c.ior_below / c.ior_above;
}

BsdfSample antireflective_sample(Antireflective r, SurfaceContext c, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    float eta = antireflective_eta(c, side);
    if (eta == 1.0) return BsdfSample(-wo, Spectrum(1), 1.0, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
    vec3 wi;
    if (!refract_direction(vec3(wo.xy, wo.z * side), vec3(0, 0, 1), wo.z * side, eta, wi))
        return BsdfSample(vec3(-wo.xy, wo.z), Spectrum(1), 1.0, EVENT_REFLECT | EVENT_DELTA);
    wi.z *= side;
    // Refraction keeps radiance over squared index (Veach 1997 sec. 5.2).
    return BsdfSample(wi, Spectrum(c.importance ? 1.0 : 1.0 / (eta * eta)), 1.0, EVENT_TRANSMIT | EVENT_DELTA);
}

Mueller antireflective_mueller(Antireflective r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    float side = from.z < 0.0 ? -1.0 : 1.0;
    float eta = antireflective_eta(c, side);
    if (eta == 1.0) return passing(to);
    vec3 axis = facet_axis(to, vec3(0, 0, side));
    if (from.z * to.z > 0.0) return fresnel_dielectric_mueller(axis, abs(from.z), eta, true);
    return phase_plate(axis, Spectrum(0), Spectrum(1), Spectrum(0));
}

Spectrum antireflective_transparency(Antireflective r, SurfaceContext c, vec3 wo) { return Spectrum(c.ior_above == c.ior_below ? 1.0 : 0.0); }
bool antireflective_is_delta(Antireflective r, SurfaceContext c) { return true; }
bool antireflective_is_opaque(Antireflective r, SurfaceContext c) { return c.ior_above != c.ior_below; }
