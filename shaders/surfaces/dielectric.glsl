// A clear interface between two media: smooth (Fresnel's equations, Snell's law) or a GGX microfacet surface
// that reflects and refracts (Walter et al. 2007), sampled by visible normals. The media say the refractive
// indices.
//
// One event at a facet is modelled, so rough surfaces lose what meets a facet more often; `multiscatter`
// gives it back as broad lobes on both sides after Kulla & Conty 2017, which are reciprocal and lossless.
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

// Density of scattering at facets more than once, with |cos| mu_i, in the mix with `single`.
float dielectric_multiscatter_mix(Dielectric r, float single, float mu_o, float mu_i, bool reflects, float eta) {
    float transmitted = ggx_dielectric_multiscatter_transmission(r.alpha, eta);
    float lobe = ggx_multiscatter_pdf(mu_i, r.alpha) * (reflects ? 1.0 - transmitted : transmitted);
    return mix(single, lobe, dielectric_multiscatter_part(r, mu_o, eta));
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
    if (r.multiscatter) {
        float eta_back = reflects ? eta : 1.0 / eta;
        value += ggx_dielectric_multiscatter(wo.z, wi.z, r.alpha, eta);
        there = dielectric_multiscatter_mix(r, there, wo.z, abs(wi.z), reflects, eta);
        back = dielectric_multiscatter_mix(r, back, abs(wi.z), wo.z, reflects, eta_back);
    }
    return SurfacePair(Spectrum(reflects ? value : value * dielectric_transmission_scale(c, eta)), there, back);
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
        reflects = choice >= ggx_dielectric_multiscatter_transmission(r.alpha, eta);
        if (!reflects) wi.z = -wi.z;
    }
    if (reflects ? wi.z <= 0.0 : wi.z >= 0.0) return no_bsdf_sample();
    return scattered(vec3(wi.xy, wi.z * side), reflects ? EVENT_REFLECT : EVENT_TRANSMIT);
}

Spectrum dielectric_transparency(Dielectric r, SurfaceContext c, vec3 wo) {
    return Spectrum(c.ior_above == c.ior_below ? 1.0 : 0.0);
}
bool dielectric_is_opaque(Dielectric r, SurfaceContext c) { return c.ior_above != c.ior_below; }
