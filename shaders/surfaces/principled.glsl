// The metallic-roughness material of glTF 2.0 (specification, appendix B) with KHR_materials_ior and
// KHR_materials_transmission: a mix, by `metallic`, of a metal and a dielectric that is diffuse below (or
// lets light through, by `transmission`).
//
// Differences from the appendix, which leaves energy to the implementer:
// - The diffuse part is c (1 - D(wo)) (1 - D(wi)) / (pi (1 - D_avg)), where D bounds the albedo of the
//   specular part from above. So the sum never exceeds 1, and it stays reciprocal; smooth and with c = 1
//   nothing is lost.
// - Roughness below 0.01 (alpha below 1e-4) is a perfect mirror.
// - Not thin (KHR_materials_volume), the transmitting part refracts between the two media as the class
//   `dielectric` does, tinted by the base color at each transmission. Thin and smooth, light passes straight on.
//   Rough facets count as smooth where the media match so nearly that refraction is not resolved.
#include "lib/fresnel.glsl"
#include "lib/microfacet.glsl"

struct Principled {
    vec4 base_color;                        //: [1, 1, 1, 1]. Linear color, alpha; vertex colors multiply it.
    TextureRef base_color_texture;          //: none. Multiplies base_color.
    float metallic;                         //: 1 in [0, 1]. 0 = dielectric, 1 = metal.
    float roughness;                        //: 1 in [0, 1]. GGX width alpha is its square.
    TextureRef metallic_roughness_texture;  //: none data. Green multiplies roughness, blue metallic.
    uint alpha_mode;                        //: 0 in [0, 2]. 0 = opaque, 1 = mask, 2 = blend.
    float alpha_cutoff;                     //: 0.5 in [0, inf). Masked surfaces are absent below it.
    float ior;                              //: 1.5 in [0, inf). Sets the reflection of the dielectric.
    float transmission;                     //: 0 in [0, 1]. Part of the dielectric that is clear.
    TextureRef transmission_texture;        //: none data. Red multiplies transmission.
    bool thin;                              //: false. Transmission does not refract.
};

Principled principled_resolve(Principled r, SurfaceContext c) {
    r.base_color *= c.color * texture_value(r.base_color_texture, c.uv0, c.uv1);
    vec4 metallic_roughness = texture_value(r.metallic_roughness_texture, c.uv0, c.uv1);
    r.metallic *= metallic_roughness.b;
    r.roughness *= metallic_roughness.g;
    r.transmission *= texture_value(r.transmission_texture, c.uv0, c.uv1).r;
    return r;
}

// The material at a point.
struct PrincipledMaterial {
    float coverage;     // 1 - part that passes unscattered because of alpha
    Spectrum color;
    float metal;        // parts of the covered surface; their sum is 1: metal,
    float opaque;       //   dielectric that is diffuse below,
    float transmitter;  //   dielectric that lets light through
    bool thin;          // without refraction
    float f0;           // of the dielectric
    float alpha;        // GGX width
    bool smooth_facets; // what the facets reflect and transmit is not scattered
    float eta;          // index of the medium on the far side over that on the side of wo
    bool importance;
};

PrincipledMaterial principled_material(Principled r, SurfaceContext c, float side) {
    PrincipledMaterial m;
    float alpha = clamp(r.base_color.a, 0.0, 1.0);
    m.coverage = r.alpha_mode == 0u ? 1.0 : r.alpha_mode == 1u ? (alpha < r.alpha_cutoff ? 0.0 : 1.0) : alpha;
    m.color = factor_of_rgb(clamp(r.base_color.rgb, vec3(0), vec3(1)));
    m.metal = clamp(r.metallic, 0.0, 1.0);
    m.transmitter = (1.0 - m.metal) * clamp(r.transmission, 0.0, 1.0);
    m.opaque = max((1.0 - m.metal) - m.transmitter, 0.0);
    m.thin = r.thin;
    m.f0 = square((r.ior - 1.0) / (r.ior + 1.0));
    m.alpha = square(clamp(r.roughness, 0.0, 1.0));
    m.smooth_facets = m.alpha < SMOOTH_ALPHA || (!m.thin && m.transmitter > 0.0 &&
                                                 interface_is_smooth(m.alpha, c.ior_above, c.ior_below));
    m.eta = side < 0.0 ? c.ior_above / c.ior_below : c.ior_below / c.ior_above;
    m.importance = c.importance;
    return m;
}

// D(mu): not less than the albedo of the dielectric's specular part. That albedo is f0 (E - B) + B, where E
// <= 1 is the albedo of facets that reflect everything and B the same weighted by Schlick's (1 - wo·h)^5. B
// is less than q (1 - mu)^p + 2e-4, with q and p fitted to B by quadrature.
float principled_bound(PrincipledMaterial m, float mu, out float average) {
    float p = 5.0, q = 1.0, tail = 0.0;
    if (!m.smooth_facets) {
        p = 2.5 + 2.5 * exp(-6.5 * m.alpha);
        q = 0.9998 / (1.0 + m.alpha * (3.2147 + m.alpha * (51.812 - m.alpha * 5.0068)));
        tail = 2e-4;
    }
    average = m.f0 + (1.0 - m.f0) * (q * 2.0 / ((p + 1.0) * (p + 2.0)) + tail);
    return m.f0 + (1.0 - m.f0) * (q * pow(max(1.0 - mu, 1e-7), p) + tail);
}

// Diffuse f |cos wi|, 1/sr.
Spectrum principled_diffuse(PrincipledMaterial m, float mu_o, float mu_i) {
    float average;
    float o = principled_bound(m, mu_o, average), i = principled_bound(m, mu_i, average);
    return m.color * (m.opaque * (1.0 - o) * (1.0 - i) * mu_i / (PI * max(1.0 - average, 1e-6)));
}

// What a facet seen at cos_o reflects and transmits, as power.
void principled_facet(PrincipledMaterial m, float cos_o, out Spectrum reflected, out Spectrum transmitted) {
    float s = schlick_weight(cos_o);
    float f = mix(m.f0, 1.0, s);
    float f_transmitter = m.thin ? f : fresnel_dielectric(cos_o, m.eta);
    reflected = m.metal * mix(m.color, Spectrum(1), s) + m.opaque * f + m.transmitter * f_transmitter;
    transmitted = m.transmitter * (1.0 - f_transmitter) * m.color;
}

// Probability of reflection at a facet.
float principled_reflection_part(Spectrum reflected, Spectrum transmitted) {
    float r = brightness(reflected), t = brightness(transmitted);
    return r + t > 0.0 ? r / (r + t) : 1.0;
}

float principled_transmission_scale(PrincipledMaterial m) {
    return m.thin || m.importance ? 1.0 : 1.0 / (m.eta * m.eta);
}

// Facets that transmit without changing the direction.
bool principled_transmits_straight(PrincipledMaterial m) {
    return m.smooth_facets && (m.thin || m.eta == 1.0);
}

// `sample` first chooses among what passes straight on, the diffuse part and the facets.
struct PrincipledChoice {
    Spectrum straight;                                             // part of the light
    float straight_probability, diffuse_probability, facet_probability;  // their sum is 1
};

PrincipledChoice principled_choice(PrincipledMaterial m, float mu_o) {
    Spectrum reflected, transmitted;
    principled_facet(m, mu_o, reflected, transmitted);
    PrincipledChoice choice;
    choice.straight = Spectrum(1.0 - m.coverage);
    if (principled_transmits_straight(m)) {
        choice.straight += m.coverage * transmitted;
        transmitted = Spectrum(0);
    }
    float average;
    float straight = brightness(choice.straight);
    float diffuse = m.coverage * m.opaque * brightness(m.color) * (1.0 - principled_bound(m, mu_o, average));
    // Tilted facets reflect more than the level surface would, so they keep a share even where that is
    // nothing.
    float facets = m.coverage * max(brightness(reflected + transmitted), 0.02);
    float scale = 1.0 / (straight + diffuse + facets);
    choice.straight_probability = straight * scale;
    choice.diffuse_probability = diffuse * scale;
    choice.facet_probability = facets * scale;
    return choice;
}

// f |cos wi| and its pdf, for wo above.
Spectrum principled_evaluate(PrincipledMaterial m, vec3 wo, vec3 wi, out float pdf) {
    PrincipledChoice choice = principled_choice(m, wo.z);
    bool reflects = wi.z > 0.0;
    Spectrum value = reflects ? m.coverage * principled_diffuse(m, wo.z, wi.z) : Spectrum(0);
    pdf = reflects ? choice.diffuse_probability * INV_PI * wi.z : 0.0;
    if (m.smooth_facets) return value;

    bool refracts = !reflects && !m.thin;
    vec3 mirrored = vec3(wi.xy, abs(wi.z));
    vec3 h = refracts ? refraction_normal(wo, wi, m.eta) : reflection_normal(wo, mirrored);
    Spectrum reflected, transmitted;
    principled_facet(m, dot(wo, h), reflected, transmitted);
    float reflection_part = principled_reflection_part(reflected, transmitted);
    float facet_pdf = ggx_reflection_pdf(wo, h, m.alpha);
    if (refracts) facet_pdf = ggx_refraction_pdf(wo, wi, h, m.alpha, m.eta);
    pdf += choice.facet_probability * facet_pdf * (reflects ? reflection_part : 1.0 - reflection_part);
    Spectrum part = reflects ? reflected : transmitted * principled_transmission_scale(m);
    return value + m.coverage * part * (facet_pdf * ggx_g1(mirrored.z, m.alpha));
}

Spectrum principled_eval(Principled r, SurfaceContext c, vec3 wo, vec3 wi) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    float pdf;
    wo.z *= side, wi.z *= side;
    return principled_evaluate(principled_material(r, c, side), wo, wi, pdf);
}

float principled_pdf(Principled r, SurfaceContext c, vec3 wo, vec3 wi) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    float pdf;
    wo.z *= side, wi.z *= side;
    principled_evaluate(principled_material(r, c, side), wo, wi, pdf);
    return pdf;
}

BsdfSample principled_sample(Principled r, SurfaceContext c, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side;
    PrincipledMaterial m = principled_material(r, c, side);
    PrincipledChoice choice = principled_choice(m, wo.z);
    if (u.z < choice.straight_probability)
        return BsdfSample(vec3(-wo.xy, -wo.z * side), choice.straight / choice.straight_probability,
                          choice.straight_probability, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
    float rest = u.z - choice.straight_probability;
    bool diffuse = rest < choice.diffuse_probability;

    vec3 h = m.smooth_facets ? vec3(0, 0, 1) : ggx_sample_visible(wo, m.alpha, u.xy);
    float cos_o = dot(wo, h);
    Spectrum reflected, transmitted;
    principled_facet(m, cos_o, reflected, transmitted);
    if (principled_transmits_straight(m)) transmitted = Spectrum(0);
    float reflection_part = principled_reflection_part(reflected, transmitted);
    bool reflects = diffuse || rest - choice.diffuse_probability < reflection_part * choice.facet_probability;
    vec3 wi = 2.0 * cos_o * h - wo;
    if (!reflects && m.thin) wi.z = -wi.z;
    if (!reflects && !m.thin) refract_direction(wo, h, cos_o, m.eta, wi);
    if (diffuse) wi = warp_cosine_hemisphere(u.xy);
    if (reflects ? wi.z <= 0.0 : wi.z >= 0.0) return no_bsdf_sample();

    BsdfSample result;
    result.event = reflects ? EVENT_REFLECT : EVENT_TRANSMIT;
    if (m.smooth_facets && !diffuse) {
        result.event |= EVENT_DELTA;
        result.pdf = choice.facet_probability * (reflects ? reflection_part : 1.0 - reflection_part);
        result.weight = m.coverage * (reflects ? reflected : transmitted * principled_transmission_scale(m));
    } else {
        result.weight = principled_evaluate(m, wo, wi, result.pdf);
    }
    if (!(result.pdf > 0.0)) return no_bsdf_sample();
    result.weight /= result.pdf;
    result.wi = vec3(wi.xy, wi.z * side);
    return result;
}

Spectrum principled_transparency(Principled r, SurfaceContext c, vec3 wo) {
    return principled_choice(principled_material(r, c, wo.z < 0.0 ? -1.0 : 1.0), abs(wo.z)).straight;
}

bool principled_is_delta(Principled r, SurfaceContext c) {
    uint textures = r.base_color_texture.index & r.metallic_roughness_texture.index & r.transmission_texture.index;
    r.base_color *= c.color;
    PrincipledMaterial m = principled_material(r, c, 1.0);
    return textures == NO_RECORD && (m.coverage == 0.0 || (m.smooth_facets && m.opaque == 0.0));
}
bool principled_is_opaque(Principled r, SurfaceContext c) { return r.alpha_mode == 0u && r.transmission == 0.0; }
