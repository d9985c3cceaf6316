// The lobes of the class `principled` (surfaces/principled.glsl) at one point of it.
#include "lib/principled_material.glsl"

// Not less than the albedo at mu of facets that reflect f0 and at grazing angles f90. That albedo is f0 (E - B) + f90 B,
// where E <= 1 is the albedo of facets that reflect everything and B the same weighted by Schlick's (1 - wo·h)^5. B is less
// than q (1 - mu)^p + 2e-4, with q and p fitted to B by quadrature.
float schlick_bound(float f0, float f90, float alpha, bool is_smooth, float mu, out float average) {
    float p = 5.0, q = 1.0, tail = 0.0;
    if (!is_smooth) {
        p = 2.5 + 2.5 * exp(-6.5 * alpha);
        q = 0.9998 / (1.0 + alpha * (3.2147 + alpha * (51.812 - alpha * 5.0068)));
        tail = 2e-4;
    }
    average = f0 + (f90 - f0) * (q * 2.0 / ((p + 1.0) * (p + 2.0)) + tail);
    return f0 + (f90 - f0) * (q * pow(max(1.0 - mu, 1e-7), p) + tail);
}

// D(mu), of the dielectric's specular part. Of two widths, the greater of their bounds.
float principled_bound(PrincipledMaterial m, float mu, out float average) {
    float f0 = max_component(m.f0);
    float bound = schlick_bound(f0, m.f90, principled_width(m.alpha, 0u), m.smooth_facets, mu, average);
    if (PRINCIPLED_WIDTHS > 1u) {
        float other;
        bound = max(bound, schlick_bound(f0, m.f90, principled_width(m.alpha, 1u), m.smooth_facets, mu, other));
        average = max(average, other);
    }
    bound_film(m.film, m.f90, mu, m.smooth_facets ? 0.0 : principled_width(m.alpha, 0u), bound, average);
    return bound;
}

// What the coat leaves, and coat and sheen together, of light along two directions.
const float COAT_F0 = 0.04;  // of index 1.5
float principled_coat_fresnel(PrincipledMaterial m, float cos_o) {
    return m.coat * mix(COAT_F0, 1.0, schlick_weight(cos_o));
}
float principled_coat_passes(PrincipledMaterial m, vec3 w) {
    float mu = coat_cosine(m.coat_normal, w);
    if (!(m.coat > 0.0) || !is_above_coat(mu)) return 1.0;
    float average;
    return 1.0 - m.coat * schlick_bound(COAT_F0, 1.0, m.coat_alpha, m.coat_alpha < SMOOTH_ALPHA, mu, average);
}
// What the coat and the sheen let pass; the coat alone: `coat_passes`.
float principled_layers_pass(PrincipledMaterial m, vec3 w, out float coat_passes) {
    coat_passes = principled_coat_passes(m, w);
    return m.sheen_most > 0.0 ? coat_passes * (1.0 - m.sheen_most * sheen_albedo_bound(w.z, m.sheen_roughness)) : coat_passes;
}

float principled_transmission_scale(PrincipledMaterial m) {
    return m.thin || m.importance ? 1.0 : 1.0 / (m.eta * m.eta);
}

// Diffuse f |cos wi|, 1/sr; mu_i < 0 where it goes through.
Spectrum principled_diffuse(PrincipledMaterial m, float mu_o, float mu_i) {
    float average;
    float o = principled_bound(m, mu_o, average), i = principled_bound(m, abs(mu_i), average);
    Spectrum part = mu_i > 0.0 ? m.diffuse_reflected : m.diffuse_transmitted * (m.importance ? 1.0 : 1.0 / (m.eta * m.eta));
    return part * (m.opaque * (1.0 - o) * (1.0 - i) * abs(mu_i) / (PI * max(1.0 - average, 1e-6)));
}

// Part of the diffuse samples that go through.
float principled_diffuse_through(PrincipledMaterial m) {
    float r = brightness(m.diffuse_reflected), t = brightness(m.diffuse_transmitted);
    return t > 0.0 ? t / (r + t) : 0.0;
}

// What a facet seen at cos_o reflects and transmits, as power.
void principled_facet(PrincipledMaterial m, float cos_o, out Spectrum reflected, out Spectrum transmitted) {
    float s = schlick_weight(cos_o);
    Spectrum f = mix(m.f0, Spectrum(m.f90), s);
    Spectrum f_transmitter = f;
    if (!m.thin) {
        // Fresnel's equations, coloured and scaled as Schlick's formula is; beyond the critical angle all is reflected.
        float exact = fresnel_dielectric(cos_o, m.eta), normal = square((m.eta - 1.0) / (m.eta + 1.0));
        f_transmitter = Spectrum(1);
        if (exact < 1.0)
            f_transmitter = min(exact * mix(m.tint, Spectrum(m.f90), (exact - normal) / (1.0 - normal)), Spectrum(m.f90));
    }
    Spectrum f_metal = mix(m.color, Spectrum(1), s);
    Spectrum passes = Spectrum(1.0 - max_component(f_transmitter));  // a coloured reflection leaves no other colour behind
    reflect_by_film(m.film, vec3(m.metal, m.opaque, m.transmitter), m.thin, m.near, m.eta, m.f90, cos_o, f_metal, f, f_transmitter,
                    passes);
    reflected = m.metal * f_metal + m.opaque * f + m.transmitter * f_transmitter;
    transmitted = m.transmitter * passes * m.color;
}

// Probability of reflection at a facet.
float principled_reflection_part(Spectrum reflected, Spectrum transmitted) {
    float r = brightness(reflected), t = brightness(transmitted);
    return r + t > 0.0 ? r / (r + t) : 1.0;
}

// Facets that transmit without changing the direction.
bool principled_transmits_straight(PrincipledMaterial m) {
    return m.smooth_facets && (m.thin || m.eta == 1.0);
}

// `sample` first chooses among what passes straight on, the diffuse part, coat, sheen and the facets.
struct PrincipledChoice {
    Spectrum reflected, transmitted;  // by the level surface, but what passes straight on:
    Spectrum straight;                // part of the light
    float straight_probability, diffuse_probability, sheen_probability, facet_probability;  // these and
    vec2 coat_probability;                                                                  //   its two ways sum to 1
    float passes, coat_passes;  // of principled_layers_pass() for the direction it was made for
};

PrincipledChoice principled_choice(PrincipledMaterial m, vec3 wo) {
    float mu_o = wo.z;
    Spectrum reflected, transmitted;
    principled_facet(m, mu_o, reflected, transmitted);
    PrincipledChoice choice;
    choice.straight = Spectrum(0);
    if (principled_transmits_straight(m)) {
        choice.straight = m.coverage * transmitted;
        transmitted = Spectrum(0);
    }
    choice.reflected = reflected, choice.transmitted = transmitted;
    float passes = choice.passes = principled_layers_pass(m, wo, choice.coat_passes);
    choice.straight = Spectrum(1.0 - m.coverage) + passes * choice.straight;
    float average;
    float straight = brightness(choice.straight);
    float diffuse = m.coverage * passes * m.opaque * brightness(m.diffuse_reflected + m.diffuse_transmitted) *
                    (1.0 - principled_bound(m, mu_o, average));
    // Tilted facets reflect more than the level surface would, so they keep a share even where that is
    // nothing.
    float facets = m.coverage * max(passes * brightness(reflected + transmitted), 0.02);
    vec2 coat = vec2(0);
    float sheen = 0.0;
    for (uint way = 0u; way < (m.importance ? COAT_WAYS : 1u) && m.coat > 0.0; ++way) {
        float mu = coat_cosine(m.coat_normal, coat_way(way, true, wo));
        if (is_above_coat(mu)) coat[way] = m.coverage * max(principled_coat_fresnel(m, mu), 0.02);
    }
    if (m.sheen_most > 0.0)
        sheen = m.coverage * choice.coat_passes * brightness(m.sheen) *
                max(sheen_albedo_bound(mu_o, m.sheen_roughness), 0.02);
    float scale = 1.0 / (straight + diffuse + coat.x + coat.y + sheen + facets);
    choice.straight_probability = straight * scale;
    choice.diffuse_probability = diffuse * scale;
    choice.coat_probability = coat * scale;
    choice.sheen_probability = sheen * scale;
    choice.facet_probability = facets * scale;
    return choice;
}

// f |cos wi| and its pdf, for wo above; directions turned.
Spectrum principled_scattering(PrincipledMaterial m, vec3 wo, vec3 wi, out float pdf) {
    PrincipledChoice choice = principled_choice(m, wo);
    bool reflects = wi.z > 0.0;
    vec3 mirrored = vec3(wi.xy, abs(wi.z));
    float coat_passes, passes_there = principled_layers_pass(m, mirrored, coat_passes);
    float passes = m.coverage * pass_layers(m.coat_normal, m.importance, choice.passes, passes_there);
    float diffuse_through = principled_diffuse_through(m);
    Spectrum value = passes * principled_diffuse(m, wo.z, wi.z);
    pdf = choice.diffuse_probability * INV_PI * mirrored.z * (reflects ? 1.0 - diffuse_through : diffuse_through);
    if (m.sheen_most > 0.0 && reflects) {
        float below_coat = pass_layers(m.coat_normal, m.importance, choice.coat_passes, coat_passes);
        value += m.coverage * below_coat * sheen_reflection(wo, wi, m.sheen_roughness) * m.sheen;
        pdf += choice.sheen_probability * 0.5 * INV_PI;
    }
    if (m.coat > 0.0 && m.coat_alpha >= SMOOTH_ALPHA && reflects) {
        for (uint way = 0u; way < COAT_WAYS; ++way) {
            vec3 from = coat_way(way, m.importance, wo), to = coat_way(way, !m.importance, wi);
            vec3 o = to_coat(m.coat_normal, from), i = to_coat(m.coat_normal, to), h = reflection_normal(o, i);
            if (!is_above_coat(o.z) || !is_above_coat(i.z)) continue;
            value += m.coverage * principled_coat_fresnel(m, dot(o, h)) * ggx_reflection(o, i, h, m.coat_alpha) *
                     coat_correction(m.coat_normal, m.importance, from, to);
            pdf += choice.coat_probability[m.importance ? way : 0u] * ggx_reflection_pdf(o, h, m.coat_alpha);
        }
    }
    if (m.smooth_facets) return value;

    bool refracts = !reflects && !m.thin;
    vec3 h = refracts ? refraction_normal(wo, wi, m.eta) : reflection_normal(wo, mirrored);
    Spectrum reflected, transmitted;
    principled_facet(m, dot(wo, h), reflected, transmitted);
    float reflection_part = principled_reflection_part(reflected, transmitted);
    float facet_pdf = ggx_reflection_pdf(wo, h, m.alpha);
    if (refracts) facet_pdf = ggx_refraction_pdf(wo, wi, h, m.alpha, m.eta);
    pdf += choice.facet_probability * facet_pdf * (reflects ? reflection_part : 1.0 - reflection_part);
    Spectrum part = reflects ? reflected : transmitted * principled_transmission_scale(m);
    return value + passes * part * (facet_pdf * ggx_g1(mirrored, m.alpha));
}

// The part that is reflected or refracted as at a perfectly smooth surface, and its probability.
// A coat whose normal is another reflects elsewhere than the facets: `coat` says which of the two is meant, and wo is the way of light.
Spectrum principled_delta(PrincipledMaterial m, vec3 wo, vec3 wi, PrincipledChoice choice, bool coat, out float probability) {
    bool reflects = wi.z > 0.0;
    Spectrum value = Spectrum(0);
    probability = 0.0;
    bool apart = coat_is_apart(m.coat_normal);
    bool facets = m.smooth_facets && !(apart && coat), coat_too = reflects && (coat || !apart);
    if (facets) {
        float part = principled_reflection_part(choice.reflected, choice.transmitted);
        probability = choice.facet_probability * (reflects ? part : 1.0 - part);
        float coat_passes;
        float passes_there = principled_layers_pass(m, vec3(wi.xy, abs(wi.z)), coat_passes);
        value = pass_layers(m.coat_normal, m.importance, choice.passes, passes_there) *
                (reflects ? choice.reflected : choice.transmitted * principled_transmission_scale(m));
    }
    if (coat_too && m.coat > 0.0 && m.coat_alpha < SMOOTH_ALPHA) {
        probability += wo.z < 0.0 ? choice.coat_probability.y : choice.coat_probability.x;
        value += Spectrum(principled_coat_fresnel(m, coat_cosine(m.coat_normal, wo)) *
                          coat_correction(m.coat_normal, m.importance, wo, wi));
    }
    return m.coverage * value;
}
