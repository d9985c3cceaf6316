// Microfacet surfaces with the GGX (Trowbridge-Reitz) distribution, isotropic, width alpha (Walter et al.
// 2007).
//
// Shadowing and masking are Smith's, taken as independent: G = G1(wo) G1(wi) (Walter et al. 2007 eq. 23), the
// form of glTF's appendix B. Directions are local with wo.z >= 0: callers mirror z where the path comes from
// below. All quotients are arranged so that wo.z = 0 and wi.z = 0 give finite values.

#include "lib/accurate_math.glsl"

// Narrower lobes than this are treated as perfectly smooth: float directions cannot resolve them.
const float SMOOTH_ALPHA = 1e-4;

float ggx_slant(float mu, float alpha) { return sqrt(mu * mu + alpha * alpha * (1.0 - mu) * (1.0 + mu)); }

// Part of the facets facing the direction that it sees, mu = |w.z|.
float ggx_g1(float mu, float alpha) { return mu > 0.0 ? 2.0 * mu / (mu + ggx_slant(mu, alpha)) : 0.0; }

// Density of facet normals per solid angle times projected area (Walter et al. 2007 eq. 33), 1/sr. The sine
// comes from x and y, since 1 - h.z² would lose the digits of a narrow lobe.
float ggx_d(vec3 h, float alpha) {
    float a2 = alpha * alpha;
    float q = a2 * h.z * h.z + h.x * h.x + h.y * h.y;
    return a2 / (PI * q * q);
}

// Density of the facet normals that wo sees (Heitz 2018 eq. 3): G1(wo) D(h) max(0, wo·h) / wo.z, 1/sr.
float ggx_visible_d(vec3 wo, vec3 h, float alpha) {
    return 2.0 * max(dot(wo, h), 0.0) * ggx_d(h, alpha) / (wo.z + ggx_slant(wo.z, alpha));
}

// A facet normal with that density (Dupuy & Benyoub 2023, spherical caps). The cap's height above the horizon
// is formed without cancellation.
vec3 ggx_sample_visible(vec3 wo, float alpha, vec2 u) {
    vec3 w = normalize(vec3(wo.xy * alpha, wo.z));
    float drop = u.x * (1.0 + w.z);  // 1 - z of the point on the cap
    float r = sqrt(max(0.0, drop * (2.0 - drop)));
    vec3 h = vec3(r * cos_sin_turns(u.y) + w.xy, (1.0 - u.x) * (1.0 + w.z));
    return normalize(vec3(h.xy * alpha, max(h.z, 1e-10)));
}

// The facet normal that reflects wo into wi, both above. Opposite directions at the horizon have none: then the
// surface's own, which keeps all that follows finite.
vec3 reflection_normal(vec3 wo, vec3 wi) {
    vec3 h = wo + wi;
    float l2 = dot(h, h);
    return l2 > 1e-14 ? h * inversesqrt(l2) : vec3(0, 0, 1);
}

// f |cos wi| of a mirror-like facet that reflects everything, 1/sr: D G1(wo) G1(wi) / (4 wo.z) (Walter et al.
// 2007 eq. 20). wi.z > 0.
float ggx_reflection(vec3 wo, vec3 wi, vec3 h, float alpha) {
    return ggx_d(h, alpha) * ggx_g1(wi.z, alpha) / (2.0 * (wo.z + ggx_slant(wo.z, alpha)));
}

// Density of reflecting at a visible facet, 1/sr: the density of h over 4 wo·h.
float ggx_reflection_pdf(vec3 wo, vec3 h, float alpha) {
    return ggx_d(h, alpha) / (2.0 * (wo.z + ggx_slant(wo.z, alpha)));
}

// The facet normal that refracts wo (above) into wi (below), on the side of wo (Walter et al. 2007 eq. 16).
vec3 refraction_normal(vec3 wo, vec3 wi, float eta) {
    vec3 h = wo + eta * wi;
    float l2 = dot(h, h);
    return l2 > 1e-14 ? h * (h.z < 0.0 ? -inversesqrt(l2) : inversesqrt(l2)) : vec3(0, 0, 1);
}

// Solid angle of the facet normals over that of the refracted directions: eta² |wi·h| / (wo·h + eta wi·h)² (Walter et
// al. 2007 eq. 17); 0 where h refracts no light from wo to wi. The root of the denominator is (1 - eta²) / (wo·h + eta
// |wi·h|) by Snell's law, which does not cancel.
float refraction_jacobian(vec3 wo, vec3 wi, vec3 h, float eta) {
    float cos_o = dot(wo, h), cos_i = -dot(wi, h);
    if (cos_o <= 0.0 || cos_i <= 0.0 || eta == 1.0) return 0.0;
    float root = (eta - 1.0) * (eta + 1.0) / (cos_o + eta * cos_i);
    return eta * eta * cos_i / (root * root);
}

// Density of refracting into wi at a visible facet, 1/sr. f |cos wi| of power transport is this times G1(wi) and the
// transmitted part.
float ggx_refraction_pdf(vec3 wo, vec3 wi, vec3 h, float alpha, float eta) {
    return ggx_visible_d(wo, h, alpha) * refraction_jacobian(wo, wi, h, eta);
}

// Density of the way back from wi (below) to wo, 1/sr: both turned around, which leaves the facet where it is.
float ggx_refraction_pdf_reverse(vec3 wo, vec3 wi, vec3 h, float alpha, float eta) {
    return ggx_refraction_pdf(-wi, -wo, h, alpha, 1.0 / eta);
}

// An interface between media so near to each other that refraction turns light by less than floats resolve
// counts as smooth, however rough it is.
bool interface_is_smooth(float alpha, float ior_above, float ior_below) {
    float difference = abs(ior_above - ior_below) / min(ior_above, ior_below);
    return alpha < SMOOTH_ALPHA || alpha * difference < 0.5 * SMOOTH_ALPHA;
}
