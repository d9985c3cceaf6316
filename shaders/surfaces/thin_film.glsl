// A film some hundred nanometres thick over a metal (eta and k) or, without eta, over the medium on the other side:
// oxides, oil on water, anti-reflection coats, soap. Its colours come from interference (lib/thin_film.glsl). Smooth or, by
// alpha, a GGX microfacet surface whose facets the film follows; one reflection or refraction at a facet is modelled.
//
// Scenes may name a "base" instead, a surface: {"class": "conductor" | "dielectric" | "principled", ...}; the last becomes
// principled with iridescence, so that a film lies on all that glTF describes. Nothing is absorbed in the film. Between
// media that match, or so nearly that refraction is not resolved, facets count as smooth: a soap film.
//
// Example:
//     {"materials": [{"name": "tempered steel", "extensions": {"ETD_optics": {
//         "surface": {"class": "thin_film", "ior": 2.4, "thickness": 55, "eta": [2.9, 2.9, 2.6], "k": [3.1, 3.3, 3.3], "alpha": 0.05}}}}]}
#include "lib/fresnel.glsl"
#include "lib/microfacet.glsl"
#include "features/thin_film_spectra.glsl"

struct ThinFilm {
    SpectrumRef ior;               //: 1.33 in [0.1, 100] ior. Real refractive index of the film.
    float thickness;               //: 300 in [0, 100000] nm. Of the film.
    TextureRef thickness_texture;  //: none data. Green multiplies thickness.
    SpectrumRef eta;               //: none in [0, inf). Real part of the index of a metal below. none = -1.
    SpectrumRef k;                 //: 0 in [0, inf). Its extinction coefficient.
    float alpha;                   //: 0 in [0, 1]. GGX width; below 1e-4 the surface is perfectly smooth.
};

ThinFilm thin_film_resolve(ThinFilm r, SurfaceContext c) {
    r.thickness *= texture_value(r.thickness_texture, c.uv0, c.uv1).g;
    return r;
}

bool thin_film_on_metal(ThinFilm r) { return max_component(untinted_value(r.eta)) >= 0.0; }

bool thin_film_is_delta(ThinFilm r, SurfaceContext c) {
    return thin_film_on_metal(r) ? r.alpha < SMOOTH_ALPHA : interface_is_smooth(r.alpha, c.ior_above, c.ior_below);
}

// Reflected part at a facet; `near` and `far`: indices of the media on the ray's side and beyond.
Spectrum thin_film_facet(ThinFilm r, float cos_o, float near, float far) {
    bool metal = thin_film_on_metal(r);
    Spectrum eta = metal ? untinted_value(r.eta) : Spectrum(far);
    Spectrum k = metal ? untinted_value(r.k) : Spectrum(0);
    return thin_film_reflectance(max(cos_o, 0.0), near, untinted_value(r.ior), r.thickness, eta, k);
}

// The surface as a ray from above sees it.
struct ThinFilmSide {
    float near, far;
    bool metal;
    float eta;    // far over near
    float scale;  // of what is transmitted: radiance over squared index is kept (Veach 1997, section 5.2)
};

ThinFilmSide thin_film_side(ThinFilm r, SurfaceContext c, float side) {
    ThinFilmSide s;
    s.near = side < 0.0 ? c.ior_below : c.ior_above;
    s.far = side < 0.0 ? c.ior_above : c.ior_below;
    s.metal = thin_film_on_metal(r);
    s.eta = s.far / s.near;
    s.scale = c.importance ? 1.0 : 1.0 / (s.eta * s.eta);
    return s;
}

// Probability of reflection.
float thin_film_reflection_part(ThinFilmSide s, Spectrum reflected) {
    return s.metal ? 1.0 : clamp(brightness(reflected), 0.02, 0.98);
}

SurfacePair thin_film_evaluate(ThinFilm r, SurfaceContext c, vec3 wo, vec3 wi) {
    if (thin_film_is_delta(r, c)) return no_surface_pair();
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side, wi.z *= side;
    ThinFilmSide s = thin_film_side(r, c, side);
    bool reflects = wi.z > 0.0;
    if (!reflects && s.metal) return no_surface_pair();
    vec3 h = reflects ? reflection_normal(wo, wi) : refraction_normal(wo, wi, s.eta);
    // The same from both sides.
    Spectrum f = thin_film_facet(r, dot(wo, h), s.near, s.far);
    float part = thin_film_reflection_part(s, f);
    float there = ggx_reflection_pdf(wo, h, r.alpha), back = ggx_reflection_pdf(wi, h, r.alpha);
    if (!reflects) {
        there = ggx_refraction_pdf(wo, wi, h, r.alpha, s.eta), back = ggx_refraction_pdf_reverse(wo, wi, h, r.alpha, s.eta);
        part = 1.0 - part;
    }
    return SurfacePair((reflects ? f : (1.0 - f) * s.scale) * (there * ggx_g1(abs(wi.z), r.alpha)), there * part, back * part);
}

BsdfSample thin_film_sample(ThinFilm r, SurfaceContext c, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side;
    ThinFilmSide s = thin_film_side(r, c, side);
    bool is_delta = thin_film_is_delta(r, c);
    vec3 h = is_delta ? vec3(0, 0, 1) : ggx_sample_visible(wo, r.alpha, u.xy);
    float cos_o = dot(wo, h);
    Spectrum f = thin_film_facet(r, cos_o, s.near, s.far);
    float part = thin_film_reflection_part(s, f);
    bool reflects = u.z < part;
    vec3 wi = 2.0 * cos_o * h - wo;
    if (!reflects && !refract_direction(wo, h, cos_o, s.eta, wi)) return no_bsdf_sample();
    if (reflects ? wi.z <= 0.0 : wi.z >= 0.0) return no_bsdf_sample();

    BsdfSample result = scattered(wi, reflects ? EVENT_REFLECT : EVENT_TRANSMIT);
    if (is_delta) {
        result.event |= EVENT_DELTA;
        result.pdf = reflects ? part : 1.0 - part;
        result.weight = (reflects ? f : (1.0 - f) * s.scale) / result.pdf;
        if (!reflects && s.eta == 1.0) wi = -wo, result.event |= EVENT_STRAIGHT;
    }
    result.wi = vec3(wi.xy, wi.z * side);
    return result;
}

Mueller thin_film_mueller(ThinFilm r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    float side = from.z < 0.0 ? -1.0 : 1.0;
    ThinFilmSide s = thin_film_side(r, c, side);
    bool reflects = from.z * to.z > 0.0;
    vec3 h = vec3(0, 0, side);
    if (!thin_film_is_delta(r, c)) {
        vec3 turn = vec3(1, 1, side);
        h = turn * (reflects ? reflection_normal(from * turn, to * turn) : refraction_normal(from * turn, to * turn, s.eta));
    }
    Spectrum eta = s.metal ? untinted_value(r.eta) : Spectrum(s.far), k = s.metal ? untinted_value(r.k) : Spectrum(0);
    return thin_film_mueller(facet_axis(to, h), abs(dot(from, h)), s.near, untinted_value(r.ior), r.thickness, eta, k, reflects);
}

Spectrum thin_film_transparency(ThinFilm r, SurfaceContext c, vec3 wo) {
    if (c.ior_above != c.ior_below || thin_film_on_metal(r)) return Spectrum(0);
    return 1.0 - thin_film_facet(r, abs(wo.z), c.ior_above, c.ior_below);
}
bool thin_film_is_opaque(ThinFilm r, SurfaceContext c) { return c.ior_above != c.ior_below || thin_film_on_metal(r); }
