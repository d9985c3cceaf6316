// The metallic-roughness material of glTF 2.0 (specification, appendix B) with KHR_materials_ior, _transmission, _specular,
// _anisotropy, _iridescence, _diffuse_transmission, _clearcoat and _sheen: a mix, by `metallic`, of a metal and a
// dielectric that is diffuse below (or lets light through, by `transmission`), under cloth fibres, under a coat of index 1.5.
//
// Differences from the appendix and the extensions, which leave energy to the implementer:
// - The diffuse part is c (1 - D(wo)) (1 - D(wi)) / (pi (1 - D_avg)), where D bounds the albedo of the
//   specular part from above. So the sum never exceeds 1, and it stays reciprocal; smooth and with c = 1
//   nothing is lost.
// - Roughness below 0.01 (alpha below 1e-4) is a perfect mirror.
// - Not thin (KHR_materials_volume), the transmitting part refracts between the two media as the class
//   `dielectric` does, tinted by the base color at each transmission. Thin and smooth, light passes straight on.
//   Rough facets count as smooth where the media match so nearly that refraction is not resolved.
// - Coat and sheen lie on both sides and scale what is below by min(p(wo), p(wi)), where 1 - p bounds their albedo from
//   above: KHR_materials_sheen's albedo scaling. What the material emits they leave as it is.
// - A coat may have normals of its own. Its cosines are about those; seen from where they face away there is no coat. What it
//   reflects to below the surface is mirrored there, and what is below is scaled by p of the camera's direction alone.
// - An iridescent film reflects by lib/thin_film.glsl, exactly, on bases whose real index follows from their reflection at
//   normal incidence in air; so it does under a coat, too.
// - Where media differ, diffuse transmission keeps radiance over squared index: of what comes from the denser side
//   only 1 / n² passes, and the rest is reflected.
//
// Example:
//     {"materials": [{"name": "blue lacquer", "pbrMetallicRoughness": {
//         "baseColorFactor": [0.02, 0.12, 0.5, 1], "metallicFactor": 0.4, "roughnessFactor": 0.5},
//         "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}}}],
//      "extensionsUsed": ["KHR_materials_clearcoat"]}
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
    float specular;                         //: 1 in [0, 1]. Strength of the dielectric's reflection.
    TextureRef specular_texture;            //: none data. Alpha multiplies specular.
    vec3 specular_color;                    //: [1, 1, 1] in [0, inf). Multiplies that reflection at normal incidence.
    TextureRef specular_color_texture;      //: none. Multiplies specular_color.
    float anisotropy;                       //: 0 in [0, 1]. alpha along the tangent is mix(alpha, 1, anisotropy²).
    float anisotropy_rotation;              //: 0 rad. Of that direction, from the tangent to the bitangent.
    TextureRef anisotropy_texture;          //: none data. Red, green: direction in [-1, 1]; blue multiplies anisotropy.
    float iridescence;                      //: 0 in [0, 1]. Part of the surface that a thin film covers.
    TextureRef iridescence_texture;         //: none data. Red multiplies iridescence.
    float iridescence_ior;                  //: 1.3 in [1, 100]. Refractive index of the film.
    float iridescence_thickness_minimum;    //: 100 in [0, 100000] nm. Of the film where the texture is 0.
    float iridescence_thickness_maximum;    //: 400 in [0, 100000] nm. Where it is 1, or there is none.
    TextureRef iridescence_thickness_texture;  //: none data. Green goes from the minimum to the maximum.
    float diffuse_transmission;             //: 0 in [0, 1]. Part of the diffuse light that goes through.
    TextureRef diffuse_transmission_texture;        //: none data. Alpha multiplies diffuse_transmission.
    vec3 diffuse_transmission_color;                //: [1, 1, 1] in [0, 1]. Linear color of that light.
    TextureRef diffuse_transmission_color_texture;  //: none. Multiplies diffuse_transmission_color.
    float clearcoat;                        //: 0 in [0, 1]. Part of the surface that a coat of index 1.5 covers.
    TextureRef clearcoat_texture;           //: none data. Red multiplies clearcoat.
    float clearcoat_roughness;              //: 0 in [0, 1]. As roughness.
    TextureRef clearcoat_roughness_texture; //: none data. Green multiplies clearcoat_roughness.
    float clearcoat_normal_scale;           //: 0. 0 = the coat has the normals of what it covers; else its own map's, scaled.
    TextureRef clearcoat_normal_texture;    //: none data. Normals of the coat in tangent space, in [0, 1].
    vec3 clearcoat_normal;                  //: [0, 0, 1]. Of the coat where no texture says it, in tangent space.
    vec3 sheen_color;                       //: [0, 0, 0] in [0, 1]. Linear color of the sheen of fibres.
    TextureRef sheen_color_texture;         //: none. Multiplies sheen_color.
    float sheen_roughness;                  //: 0 in [0, 1]. The rim widens with it; below 0.1 it stays the same.
    TextureRef sheen_roughness_texture;     //: none data. Alpha multiplies sheen_roughness.
};

#include "features/principled_anisotropy.glsl"
#include "features/principled_coat_normal.glsl"

Principled principled_resolve(Principled r, SurfaceContext c) {
    r.base_color *= c.color * texture_value(r.base_color_texture, c.uv0, c.uv1);
    vec4 metallic_roughness = texture_value(r.metallic_roughness_texture, c.uv0, c.uv1);
    r.metallic *= metallic_roughness.b;
    r.roughness *= metallic_roughness.g;
    r.transmission *= texture_value(r.transmission_texture, c.uv0, c.uv1).r;
    r.specular *= texture_value(r.specular_texture, c.uv0, c.uv1).a;
    r.specular_color *= texture_value(r.specular_color_texture, c.uv0, c.uv1).rgb;
    r.iridescence *= texture_value(r.iridescence_texture, c.uv0, c.uv1).r;
    if (r.iridescence_thickness_texture.index != NO_RECORD)
        r.iridescence_thickness_maximum = mix(r.iridescence_thickness_minimum, r.iridescence_thickness_maximum,
                                              texture_value(r.iridescence_thickness_texture, c.uv0, c.uv1).g);
    r.diffuse_transmission *= texture_value(r.diffuse_transmission_texture, c.uv0, c.uv1).a;
    r.diffuse_transmission_color *= texture_value(r.diffuse_transmission_color_texture, c.uv0, c.uv1).rgb;
    r.clearcoat *= texture_value(r.clearcoat_texture, c.uv0, c.uv1).r;
    r.clearcoat_roughness *= texture_value(r.clearcoat_roughness_texture, c.uv0, c.uv1).g;
    resolve_coat_normal(r, c);
    r.sheen_color *= texture_value(r.sheen_color_texture, c.uv0, c.uv1).rgb;
    r.sheen_roughness *= texture_value(r.sheen_roughness_texture, c.uv0, c.uv1).a;
    resolve_anisotropy(r, c);
    return r;
}

#include "lib/principled_lobes.glsl"

SurfacePair principled_evaluate(Principled r, SurfaceContext c, vec3 wo, vec3 wi) {
    SurfacePair pair = no_surface_pair();
    PrincipledMaterial m = principled_material(r, c);
    // There and back: a loop, so that the code stands once.
    for (uint way = 0u; way < (BIDIRECTIONAL == 1 ? 2u : 1u); ++way) {
        vec3 from = way == 0u ? wo : wi, to = way == 0u ? wi : wo;
        float side = from.z < 0.0 ? -1.0 : 1.0;
        from.z *= side, to.z *= side;
        principled_face(m, c, side);
        float pdf;
        Spectrum value = principled_scattering(m, principled_turned(m, from), principled_turned(m, to), pdf);
        if (way == 0u) pair.value = value, pair.pdf = pdf;
        else pair.pdf_reverse = pdf;
        if (COAT_WAYS > 1u) m.importance = !m.importance;  // of what would come back
    }
    return pair;
}

BsdfSample principled_sample(Principled r, SurfaceContext c, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side;
    PrincipledMaterial m = principled_material(r, c);
    principled_face(m, c, side);
    wo = principled_turned(m, wo);
    PrincipledChoice choice = principled_choice(m, wo);
    if (u.z < choice.straight_probability)
        return BsdfSample(-principled_turned_back(m, wo) * vec3(1, 1, side), choice.straight / choice.straight_probability,
                          choice.straight_probability, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
    // Which part, and where u.z lies within it.
    float rest = u.z - choice.straight_probability;
    bool diffuse = rest < choice.diffuse_probability;
    bool through = diffuse && rest < choice.diffuse_probability * principled_diffuse_through(m);
    bool coat = false, sheen = false;
    uint coat_part = 0u;
    if (!diffuse) {
        rest -= choice.diffuse_probability;
        coat_part = rest < choice.coat_probability.x ? 0u : 1u;
        float coat_probability = choice.coat_probability.x + choice.coat_probability.y;
        coat = rest < coat_probability;
        sheen = !coat && rest < coat_probability + choice.sheen_probability;
        rest -= coat_probability + choice.sheen_probability;
    }
    bool is_delta = !diffuse && !sheen && (coat ? m.coat_alpha < SMOOTH_ALPHA : m.smooth_facets);

    if (coat) wo = to_coat(m.coat_normal, coat_way(coat_part, m.importance, wo));
    vec3 h = vec3(0, 0, 1);
    if (!is_delta) h = ggx_sample_visible(wo, coat ? PrincipledWidth(m.coat_alpha) : m.alpha, u.xy);
    float cos_o = dot(wo, h);
    Spectrum reflected, transmitted;
    principled_facet(m, cos_o, reflected, transmitted);
    if (principled_transmits_straight(m)) transmitted = Spectrum(0);
    float reflection_part = principled_reflection_part(reflected, transmitted);
    // Where nothing is transmitted all is reflected, also where the last of the probabilities is rounded.
    bool facet_reflects = is_black(transmitted) || rest < reflection_part * choice.facet_probability;
    bool reflects = diffuse ? !through : coat || sheen || facet_reflects;
    vec3 wi = 2.0 * cos_o * h - wo;
    if (!reflects && m.thin) wi.z = -wi.z;
    if (!reflects && !m.thin) refract_direction(wo, h, cos_o, m.eta, wi);
    if (diffuse) wi = warp_cosine_hemisphere(u.xy) * vec3(1, 1, through ? -1 : 1);
    if (sheen) wi = warp_sphere(vec2(0.5 * u.x, u.y));
    if (coat) {
        if (!is_above_coat(wi.z)) return no_bsdf_sample();
        wo = from_coat(m.coat_normal, wo), wi = from_coat(m.coat_normal, wi);
        wi = coat_way(wi.z < 0.0 ? 1u : 0u, !m.importance, wi);
    }
    if (reflects ? wi.z <= 0.0 : wi.z >= 0.0) return no_bsdf_sample();

    BsdfSample result = scattered(principled_turned_back(m, wi) * vec3(1, 1, side), reflects ? EVENT_REFLECT : EVENT_TRANSMIT);
    if (is_delta) {
        result.weight = principled_delta(m, wo, wi, choice, coat, result.pdf);
        if (!(result.pdf > 0.0)) return no_bsdf_sample();
        result.weight /= result.pdf;
        result.event |= EVENT_DELTA;
    }
    return result;
}

// The body takes light in and sends it out through a face of that index.
void polarize_body(inout Mueller m, Spectrum share, vec3 from, vec3 to, float ior) {
    const vec3 n = vec3(0, 0, 1);
    vec3 in_axis = facet_axis(from, n), out_axis = facet_axis(to, n);
    float enters = fresnel_dielectric_mueller(in_axis, abs(from.z), ior, false).b.x;
    float leaves = fresnel_dielectric_mueller(out_axis, abs(to.z), ior, false).b.x;
    set_body(m, share, enters * double_angle(m.from, in_axis, -from), leaves * double_angle(m.to, out_axis, to));
}

// Facets and coat polarize by Fresnel's equations about the half vector, metals as mirrors that keep s and p alike (a colour says
// no more of them), films with interference; the body depolarizes between its faces, the sheen altogether. Thin walls are taken
// as single faces.
Mueller principled_mueller(Principled r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    if ((event & EVENT_STRAIGHT) != 0u) return passing(to);
    float side = from.z < 0.0 ? -1.0 : 1.0;
    from.z *= side, to.z *= side;
    PrincipledMaterial m = principled_material(r, c);
    principled_face(m, c, side);
    vec3 o = principled_turned(m, from), i = principled_turned(m, to);
    float index = m.eta == 1.0 ? r.ior : m.eta;
    bool reflects = i.z > 0.0, is_delta = (event & EVENT_DELTA) != 0u;
    vec3 mirrored = m.thin ? vec3(i.xy, abs(i.z)) : i;
    vec3 h = vec3(0, 0, 1);
    if (reflects || m.thin) h = reflection_normal(o, mirrored);
    else if (!is_delta) h = refraction_normal(o, i, m.eta);
    float cosine = abs(dot(o, h));  // as of dielectric
    Mueller result = fresnel_dielectric_mueller(facet_axis(mirrored, h), cosine, index, reflects);
    Spectrum metal = Spectrum(0);
    if (reflects && m.metal > 0.0) {
        Spectrum reflected, transmitted;
        principled_facet(m, cosine, reflected, transmitted);
        metal = m.metal * mix(m.color, Spectrum(1), schlick_weight(cosine)) / max(reflected, Spectrum(1e-30));
        metal = clamp(metal, Spectrum(0), Spectrum(1));
        Mueller mirror = phase_plate(result.from, Spectrum(0), Spectrum(-1), Spectrum(0));
        result = mixed(result, mirror, metal);
    }
    result = polarize_by_film(m.film, result, metal, m.thin, m.near, m.eta, cosine, reflects);
    Spectrum body = Spectrum(0);
    if (!is_delta) {
        Spectrum all = Spectrum(0), facets = Spectrum(0);
        float pdf;
        for (uint k = 0u; k < 3u; ++k) {  // a loop, so that the code of all lobes stands once
            Spectrum value = principled_scattering(m, o, i, pdf);
            if (k == 0u) all = value;
            else if (k == 1u) body = all - value;
            else facets = value;
            m.diffuse_reflected = m.diffuse_transmitted = Spectrum(0);
            if (k == 1u) m.sheen = Spectrum(0);
        }
        Spectrum inverse = 1.0 / max(all, Spectrum(1e-30));
        body = clamp(body * inverse, Spectrum(0), Spectrum(1));
        result = partly(result, clamp(facets * inverse, Spectrum(0), Spectrum(1)));
    }
    vec3 turn = vec3(1, 1, side);
    result.from = principled_turned_back(m, result.from) * turn;
    result.to = principled_turned_back(m, result.to) * (i.z < 0.0 && m.thin ? vec3(1, 1, -1) * turn : turn);
    from.z *= side, to.z *= side;
    polarize_body(result, body, from, to, r.ior);
    return result;
}

Spectrum principled_transparency(Principled r, SurfaceContext c, vec3 wo) {
    PrincipledMaterial m = principled_material(r, c);
    principled_face(m, c, wo.z < 0.0 ? -1.0 : 1.0);
    return principled_choice(m, principled_turned(m, vec3(wo.xy, abs(wo.z)))).straight;
}

bool principled_is_delta(Principled r, SurfaceContext c) {
    uint textures = r.base_color_texture.index & r.metallic_roughness_texture.index & r.transmission_texture.index &
                    r.anisotropy_texture.index & r.clearcoat_texture.index & r.clearcoat_roughness_texture.index &
                    r.sheen_color_texture.index;
    r.base_color *= c.color;
    PrincipledMaterial m = principled_material(r, c);
    bool has_layers = m.sheen_most > 0.0 || (m.coat > 0.0 && m.coat_alpha >= SMOOTH_ALPHA);
    return textures == NO_RECORD && (m.coverage == 0.0 || (m.smooth_facets && m.opaque == 0.0 && !has_layers));
}
bool principled_is_opaque(Principled r, SurfaceContext c) { return r.alpha_mode == 0u && r.transmission == 0.0; }
float principled_coverage(Principled r, SurfaceContext c) {
    return covered_part(r, r.base_color.a * c.color.a * texture_value(r.base_color_texture, c.uv0, c.uv1).a);
}
