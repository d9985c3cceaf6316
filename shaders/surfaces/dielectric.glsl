// A clear interface between two media: smooth (Fresnel's equations, Snell's law) or a GGX microfacet surface
// that reflects and refracts (Walter et al. 2007), sampled by visible normals. The media say the refractive
// indices.
//
// One event at a facet is modelled, so rough surfaces lose what meets a facet more often; `multiscatter`
// gives it back as broad lobes on both sides after Kulla & Conty 2017, which are reciprocal and lossless.
//
// Example:
//     {"materials": [{"name": "glass", "extensions": {"ETD_optics": {
//         "surface": {"class": "dielectric"}, "inside": "glass"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "glass", "class": "homogeneous", "ior": 1.5}]}}}
#include "lib/fresnel.glsl"
#include "lib/microfacet.glsl"
#include "lib/microfacet_energy.glsl"

struct Dielectric {
    float alpha;        //: 0 in [0, 1]. GGX width; below 1e-4 the surface is perfectly smooth.
    bool multiscatter;  //: false. Keeps the light that meets more than one facet.
};

Dielectric dielectric_resolve(Dielectric r, SurfaceContext c) { return r; }

bool dielectric_is_delta(Dielectric r, SurfaceContext c) {
    return interface_is_smooth(r.alpha, c.ior_above, c.ior_below);
}

float dielectric_eta(SurfaceContext c, float side) {
    return side < 0.0 ? c.ior_above / c.ior_below : c.ior_below / c.ior_above;
}

// Radiance is carried from wi to wo, and radiance over squared index is what refraction keeps (Veach 1997
// sec. 5.2).
float dielectric_transmission_scale(SurfaceContext c, float eta) {
    return c.importance ? 1.0 : 1.0 / (eta * eta);
}

float dielectric_multiscatter_part(Dielectric r, float mu_o, float eta) {
    return r.multiscatter ? ggx_multiscatter_part(ggx_dielectric_loss(mu_o, r.alpha, eta)) : 0.0;
}

// Adds scattering at facets more than once: its f |cos wi| in power transport to `value`, 1/sr, its share to the densities of both
// directions. mu: |cos| of wo and wi.
void dielectric_multiscatter(Dielectric r, vec2 mu, bool reflects, float eta, inout float value, inout vec2 densities) {
    vec2 averages = ggx_dielectric_average_losses(r.alpha, eta);
    vec2 transmitted = ggx_dielectric_multiscatter_transmissions(averages, eta);
    if (reflects) transmitted = 1.0 - transmitted.xx, averages = averages.xx;
    vec2 losses;
    for (uint i = 0u; i < 2u; ++i) {  // a loop, so that the code of the loss stands once
        float loss = ggx_dielectric_loss(i == 0u ? mu.x : mu.y, r.alpha, reflects || i == 0u ? eta : 1.0 / eta);
        if (i == 0u) losses.x = loss;
        else losses.y = loss;
    }
    value += transmitted.x * losses.x * losses.y * mu.y / (PI * averages.y);
    vec2 lobes = vec2(ggx_multiscatter_pdf(mu.y, r.alpha), ggx_multiscatter_pdf(mu.x, r.alpha)) * transmitted;
    densities = mix(densities, lobes, vec2(ggx_multiscatter_part(losses.x), ggx_multiscatter_part(losses.y)));
}

SurfacePair dielectric_evaluate(Dielectric r, SurfaceContext c, vec3 wo, vec3 wi) {
    if (dielectric_is_delta(r, c)) return no_surface_pair();
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side, wi.z *= side;
    float eta = dielectric_eta(c, side);
    bool reflects = wi.z > 0.0;
    vec3 h = reflects ? reflection_normal(wo, wi) : refraction_normal(wo, wi, eta);
    float f = fresnel_dielectric(dot(wo, h), eta);
    float there, back;
    if (reflects) {
        there = f * ggx_reflection_pdf(wo, h, r.alpha), back = f * ggx_reflection_pdf(wi, h, r.alpha);
    } else {
        there = (1.0 - f) * ggx_refraction_pdf(wo, wi, h, r.alpha, eta);
        back = (1.0 - f) * ggx_refraction_pdf_reverse(wo, wi, h, r.alpha, eta);
    }
    float value = there * ggx_g1(abs(wi.z), r.alpha);
    vec2 densities = vec2(there, back);
    if (r.multiscatter) dielectric_multiscatter(r, vec2(wo.z, abs(wi.z)), reflects, eta, value, densities);
    return SurfacePair(Spectrum(reflects ? value : value * dielectric_transmission_scale(c, eta)), densities.x, densities.y);
}

BsdfSample dielectric_sample_smooth(SurfaceContext c, vec3 wo, float side, float u) {
    float eta = dielectric_eta(c, side);
    float f = fresnel_dielectric(wo.z, eta);
    if (u < f) return BsdfSample(vec3(-wo.xy, wo.z * side), Spectrum(1), f, EVENT_REFLECT | EVENT_DELTA);
    vec3 wi;
    refract_direction(wo, vec3(0, 0, 1), wo.z, eta, wi);
    wi.z *= side;
    uint event = EVENT_TRANSMIT | EVENT_DELTA;
    if (eta == 1.0) wi = vec3(-wo.xy, -wo.z * side), event |= EVENT_STRAIGHT;
    return BsdfSample(wi, Spectrum(dielectric_transmission_scale(c, eta)), 1.0 - f, event);
}

BsdfSample dielectric_sample(Dielectric r, SurfaceContext c, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side;
    if (dielectric_is_delta(r, c)) return dielectric_sample_smooth(c, wo, side, u.z);
    float eta = dielectric_eta(c, side);
    float multiscatter = dielectric_multiscatter_part(r, wo.z, eta);
    bool single = u.z >= multiscatter;
    float choice = single ? (u.z - multiscatter) / (1.0 - multiscatter) : u.z / multiscatter;

    vec3 h = ggx_sample_visible(wo, r.alpha, u.xy);
    float cos_o = dot(wo, h);
    float f = fresnel_dielectric(cos_o, eta);
    bool reflects = choice < f;
    vec3 wi = 2.0 * cos_o * h - wo;
    if (!reflects) refract_direction(wo, h, cos_o, eta, wi);
    if (!single) {
        wi = ggx_sample_multiscatter(u.xy, r.alpha);
        vec2 averages = ggx_dielectric_average_losses(r.alpha, eta);
        reflects = choice >= ggx_dielectric_multiscatter_transmissions(averages, eta).x;
        if (!reflects) wi.z = -wi.z;
    }
    if (reflects ? wi.z <= 0.0 : wi.z >= 0.0) return no_bsdf_sample();
    return scattered(vec3(wi.xy, wi.z * side), reflects ? EVENT_REFLECT : EVENT_TRANSMIT);
}

Mueller dielectric_mueller(Dielectric r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    float side = from.z < 0.0 ? -1.0 : 1.0;
    from.z *= side, to.z *= side;
    float eta = dielectric_eta(c, side);
    bool reflects = to.z > 0.0, smooth_surface = dielectric_is_delta(r, c);
    if (eta == 1.0) return passing(vec3(to.xy, to.z * side));
    vec3 h = vec3(0, 0, 1);
    if (!smooth_surface) h = reflects ? reflection_normal(from, to) : refraction_normal(from, to, eta);
    float cosine = abs(dot(from, h));  // rounding decides on which side upright facets face
    h.z *= side, to.z *= side;
    Mueller m = fresnel_dielectric_mueller(facet_axis(to, h), cosine, eta, reflects);
    if (!r.multiscatter || smooth_surface) return m;
    to.z *= side, h.z *= side;
    float f = fresnel_dielectric(cosine, eta);
    float single = reflects ? f * ggx_reflection_pdf(from, h, r.alpha) : (1.0 - f) * ggx_refraction_pdf(from, to, h, r.alpha, eta);
    single *= ggx_g1(abs(to.z), r.alpha);
    float all = single;
    vec2 unused = vec2(0);
    dielectric_multiscatter(r, vec2(from.z, abs(to.z)), reflects, eta, all, unused);
    return partly(m, Spectrum(single / max(all, 1e-30)));
}

Spectrum dielectric_transparency(Dielectric r, SurfaceContext c, vec3 wo) {
    return Spectrum(c.ior_above == c.ior_below ? 1.0 : 0.0);
}
bool dielectric_is_opaque(Dielectric r, SurfaceContext c) { return c.ior_above != c.ior_below; }
