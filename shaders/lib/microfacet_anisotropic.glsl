// lib/microfacet.glsl for facets of two widths, alpha.x along the tangent and alpha.y across it: the same lobes after the
// surface is stretched (Burley 2012, appendix B; Heitz 2014, section 5.3).
#include "lib/microfacet.glsl"

float ggx_slant(vec3 w, vec2 alpha) {
    vec2 t = w.xy * alpha;
    return sqrt(w.z * w.z + dot(t, t));
}

float ggx_g1(vec3 w, vec2 alpha) {
    float mu = abs(w.z);
    return mu > 0.0 ? 2.0 * mu / (mu + ggx_slant(w, alpha)) : 0.0;
}
float ggx_g1(vec3 w, float alpha) { return ggx_g1(abs(w.z), alpha); }

float ggx_d(vec3 h, vec2 alpha) {
    float p = alpha.x * alpha.y;
    vec3 q = vec3(alpha.y * h.x, alpha.x * h.y, p * h.z);
    float w = p / dot(q, q);
    return p * w * w * INV_PI;
}

vec3 ggx_sample_visible(vec3 wo, vec2 alpha, vec2 u) {
    // Of width 1 after stretching: the same normals.
    vec3 w = normalize(vec3(wo.xy * alpha, wo.z));
    vec3 h = ggx_sample_visible(w, 1.0, u);
    return normalize(vec3(h.xy * alpha, h.z));
}

float ggx_reflection_pdf(vec3 wo, vec3 h, vec2 alpha) { return ggx_d(h, alpha) / (2.0 * (wo.z + ggx_slant(wo, alpha))); }

float ggx_refraction_pdf(vec3 wo, vec3 wi, vec3 h, vec2 alpha, float eta) {
    return 4.0 * max(dot(wo, h), 0.0) * ggx_reflection_pdf(wo, h, alpha) * refraction_jacobian(wo, wi, h, eta);
}
