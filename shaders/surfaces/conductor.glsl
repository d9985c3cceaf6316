// A metal: smooth (a mirror) or a GGX microfacet surface. Both sides reflect.
//
// `reflectance`, where given, is the reflected part at every angle; else Fresnel's equations hold for a metal
// of complex index eta - i k in the medium on the ray's side. The defaults of eta and k make a perfect
// mirror. One reflection at a facet is modelled, so rough surfaces lose what is reflected more often;
// `multiscatter` gives it back as a broad lobe after Kulla & Conty 2017, reciprocal and lossless for
// reflectance 1.
//
// Example:
//     {"materials": [{"name": "satin gold", "extensions": {"ETD_optics": {
//         "surface": {"class": "conductor", "eta": {"name": "Au eta"}, "k": {"name": "Au k"}, "alpha": 0.12}}}}]}
#include "lib/fresnel.glsl"
#include "lib/microfacet.glsl"
#include "lib/microfacet_energy.glsl"

struct Conductor {
    SpectrumRef eta;          //: 0 in [0, inf). Real part of the refractive index.
    SpectrumRef k;            //: 1 in [0, inf). Extinction coefficient.
    SpectrumRef reflectance;  //: none in [0, 1]. Reflected at every angle, instead of eta and k. none = -1.
    float alpha;              //: 0 in [0, 1]. GGX width; below 1e-4 the surface is perfectly smooth.
    bool multiscatter;        //: false. Keeps the light that is reflected more than once between facets.
};

Conductor conductor_resolve(Conductor r, SurfaceContext c) { return r; }

Spectrum conductor_fresnel(Conductor r, SurfaceContext c, float side, float cos_o) {
    Spectrum reflectance = untinted_value(r.reflectance);
    float inv_ior = 1.0 / (side < 0.0 ? c.ior_below : c.ior_above);
    Spectrum f = fresnel_conductor(cos_o, untinted_value(r.eta) * inv_ior, untinted_value(r.k) * inv_ior);
    return mix(f, reflectance, greaterThanEqual(reflectance, Spectrum(0)));
}

// What light reflected more than once between facets adds: a lobe f = tint (1 - E(wo)) (1 - E(wi)) / (pi (1 -
// E_avg)) with tint = F_avg² E_avg / (1 - F_avg (1 - E_avg)) (Kulla & Conty 2017; Fdez-Agüera 2019 eq. 15).
Spectrum conductor_multiscatter_tint(Conductor r, SurfaceContext c, float side) {
    // F_avg = 2 ∫ F(mu) mu dmu by the three-point Gauss rule of weight mu on [0, 1].
    Spectrum f_avg = 0.139653960 * conductor_fresnel(r, c, side, 0.212340538) +
                     0.458482213 * conductor_fresnel(r, c, side, 0.590533136) +
                     0.401863827 * conductor_fresnel(r, c, side, 0.911412040);
    float loss = ggx_average_loss(r.alpha);
    return f_avg * f_avg * (1.0 - loss) / (1.0 - f_avg * loss);
}

// Part of the samples that follow the multiple-scattering lobe.
float conductor_multiscatter_part(Conductor r, float mu_o) {
    return r.multiscatter ? ggx_multiscatter_part(ggx_loss(mu_o, r.alpha)) : 0.0;
}

SurfacePair conductor_evaluate(Conductor r, SurfaceContext c, vec3 wo, vec3 wi) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side, wi.z *= side;
    if (wi.z <= 0.0 || r.alpha < SMOOTH_ALPHA) return no_surface_pair();
    vec3 h = reflection_normal(wo, wi);
    SurfacePair pair;
    pair.value = conductor_fresnel(r, c, side, dot(wo, h)) * ggx_reflection(wo, wi, h, r.alpha);
    pair.pdf = ggx_reflection_pdf(wo, h, r.alpha), pair.pdf_reverse = ggx_reflection_pdf(wi, h, r.alpha);
    if (r.multiscatter) {
        pair.value += conductor_multiscatter_tint(r, c, side) * (ggx_loss(wo.z, r.alpha) * ggx_loss(wi.z, r.alpha) *
                                                                 wi.z / (PI * ggx_average_loss(r.alpha)));
        pair.pdf = mix(pair.pdf, ggx_multiscatter_pdf(wi.z, r.alpha), conductor_multiscatter_part(r, wo.z));
        pair.pdf_reverse = mix(pair.pdf_reverse, ggx_multiscatter_pdf(wo.z, r.alpha), conductor_multiscatter_part(r, wi.z));
    }
    return pair;
}

BsdfSample conductor_sample(Conductor r, SurfaceContext c, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side;
    if (r.alpha < SMOOTH_ALPHA)
        return BsdfSample(vec3(-wo.xy, wo.z * side), conductor_fresnel(r, c, side, wo.z), 1.0,
                          EVENT_REFLECT | EVENT_DELTA);
    vec3 h = ggx_sample_visible(wo, r.alpha, u.xy);
    vec3 wi = 2.0 * dot(wo, h) * h - wo;
    if (u.z < conductor_multiscatter_part(r, wo.z)) wi = ggx_sample_multiscatter(u.xy, r.alpha);
    if (wi.z <= 0.0) return no_bsdf_sample();
    return scattered(vec3(wi.xy, wi.z * side), EVENT_REFLECT);
}

// What facets reflect more often than once keeps no polarization. A given reflectance is that of a mirror for s and p alike.
Mueller conductor_mueller(Conductor r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    float side = from.z < 0.0 ? -1.0 : 1.0;
    bool smooth_surface = r.alpha < SMOOTH_ALPHA;
    vec3 h = smooth_surface ? vec3(0, 0, side) : normalize(from + to);
    float inv_ior = 1.0 / (side < 0.0 ? c.ior_below : c.ior_above);
    float cosine = dot(from, h);
    Spectrum eta = untinted_value(r.eta) * inv_ior, k = untinted_value(r.k) * inv_ior;
    Mueller m = fresnel_conductor_mueller(facet_axis(to, h), cosine, eta, k);
    Spectrum reflectance = untinted_value(r.reflectance);
    Mueller mirror = phase_plate(m.from, Spectrum(0), Spectrum(-1), Spectrum(0));
    m = mixed(m, mirror, mix(Spectrum(0), Spectrum(1), greaterThanEqual(reflectance, Spectrum(0))));
    if (!r.multiscatter || smooth_surface) return m;
    from.z *= side, to.z *= side, h.z *= side;
    Spectrum single = conductor_fresnel(r, c, side, cosine) * ggx_reflection(from, to, h, r.alpha);
    Spectrum more = conductor_multiscatter_tint(r, c, side) *
                    (ggx_loss(from.z, r.alpha) * ggx_loss(to.z, r.alpha) * to.z / (PI * ggx_average_loss(r.alpha)));
    return partly(m, single / max(single + more, Spectrum(1e-30)));
}

Spectrum conductor_transparency(Conductor r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool conductor_is_delta(Conductor r, SurfaceContext c) { return r.alpha < SMOOTH_ALPHA; }
bool conductor_is_opaque(Conductor r, SurfaceContext c) { return true; }
