// The material of the class `principled` (surfaces/principled.glsl) at one point.
#include "lib/frames.glsl"
#include "lib/fresnel.glsl"
#include "lib/microfacet_anisotropic.glsl"
#include "lib/sheen.glsl"
#ifndef ABSENT_principled_iridescence
#include "lib/thin_film.glsl"
#endif

// Widths of GGX: one number where no material of the scene is anisotropic.
#ifdef ABSENT_principled_anisotropy
#define PrincipledWidth float
#else
#define PrincipledWidth vec2
#define SURFACES_HAVE_TANGENTS  // lib/scattering.glsl: frames follow the surface's tangent
#endif

#ifndef ABSENT_principled_clearcoat_normal_scale
#define COAT_HAS_NORMAL 1
#define SURFACES_USE_MESH_FRAME  // lib/scattering.glsl
#ifndef SURFACES_HAVE_TANGENTS
#define SURFACES_HAVE_TANGENTS
#endif
#else
#define COAT_HAS_NORMAL 0
#endif

// The material at a point.
struct PrincipledMaterial {
    float coverage;     // 1 - part that passes unscattered because of alpha
    Spectrum color;
    float metal;        // parts of the covered surface; their sum is 1: metal,
    float opaque;       //   dielectric that is diffuse below,
    float transmitter;  //   dielectric that lets light through
    bool thin;          // without refraction
    Spectrum f0;        // of the dielectric: reflected at normal incidence,
    float f90;          //   and at grazing angles
    Spectrum tint;      // of what it reflects at normal incidence, times f90
    PrincipledWidth alpha;  // GGX width
    vec2 axis;          // in the local xy plane, along which alpha.x is
    bool smooth_facets; // what the facets reflect and transmit is not scattered
    bool importance;
    float through;      // part of the diffuse light that is to go through,
    Spectrum sent;      //   and its color
    float near;         // index of the medium on the side of wo; this and what follows by principled_face:
    float eta;          // index of the medium on the far side over that
    Spectrum diffuse_reflected, diffuse_transmitted;  // parts of the diffuse light, as power
    float coat;         // covered part
    float coat_alpha;
#if COAT_HAS_NORMAL
    vec3 coat_normal_above;  // local, on the side of +z,
    vec3 coat_normal;        //   and as it is for light from the side of wo, turned
#endif
    Spectrum sheen;
    float sheen_most;   // greatest of it
    float sheen_roughness;
#ifndef ABSENT_principled_iridescence
    float iridescence;
    float film, film_thickness;   // index, nm
    Spectrum dielectric_index, metal_index;  // in air
#endif
};

#ifndef ABSENT_principled_iridescence
// Real index of what reflects f0 at normal incidence in air.
Spectrum principled_index(Spectrum f0) {
    Spectrum root = sqrt(clamp(f0, Spectrum(0), Spectrum(0.9999)));
    return (1.0 + root) / (1.0 - root);
}
#endif

PrincipledMaterial principled_material(Principled r, SurfaceContext c) {
    PrincipledMaterial m;
    float alpha = clamp(r.base_color.a, 0.0, 1.0);
    m.coverage = r.alpha_mode == 0u ? 1.0 : r.alpha_mode == 1u ? (alpha < r.alpha_cutoff ? 0.0 : 1.0) : alpha;
    Spectrum specular;
    factors_of_rgb(clamp(r.base_color.rgb, vec3(0), vec3(1)), clamp(r.diffuse_transmission_color, vec3(0), vec3(1)),
                   clamp(r.sheen_color, vec3(0), vec3(1)), max(r.specular_color, vec3(0)), m.color, m.sent, m.sheen, specular);
    m.metal = clamp(r.metallic, 0.0, 1.0);
    m.transmitter = (1.0 - m.metal) * clamp(r.transmission, 0.0, 1.0);
    m.opaque = max((1.0 - m.metal) - m.transmitter, 0.0);
    m.thin = r.thin;
    m.f90 = clamp(r.specular, 0.0, 1.0);
    m.tint = m.f90 * specular;
    m.f0 = min(square((r.ior - 1.0) / (r.ior + 1.0)) * m.tint, Spectrum(m.f90));
    float width = square(clamp(r.roughness, 0.0, 1.0));
#ifdef ABSENT_principled_anisotropy
    m.alpha = width;
#else
    m.alpha = vec2(width);
    if (r.anisotropy > 0.0) {
        m.alpha.y = max(width, SMOOTH_ALPHA);
        m.alpha.x = mix(m.alpha.y, 1.0, square(min(r.anisotropy, 1.0)));
        width = m.alpha.x;
    }
    m.axis = vec2(cos(r.anisotropy_rotation), sin(r.anisotropy_rotation));
#endif
    m.smooth_facets = width < SMOOTH_ALPHA || (!m.thin && m.transmitter > 0.0 &&
                                               interface_is_smooth(width, c.ior_above, c.ior_below));
    m.importance = c.importance;
    m.through = clamp(r.diffuse_transmission, 0.0, 1.0);
    m.sent *= m.through;
#ifndef ABSENT_principled_iridescence
    m.iridescence = clamp(r.iridescence, 0.0, 1.0);
    m.film = r.iridescence_ior, m.film_thickness = r.iridescence_thickness_maximum;
    m.dielectric_index = principled_index(m.f0 / max(m.f90, 1e-6));
    m.metal_index = principled_index(m.color);
#endif
    m.coat = clamp(r.clearcoat, 0.0, 1.0);
    m.coat_alpha = square(clamp(r.clearcoat_roughness, 0.0, 1.0));
#if COAT_HAS_NORMAL
    m.coat_normal_above = m.coat_normal = r.clearcoat_normal;
#endif
    m.sheen_most = max_component(m.sheen), m.sheen_roughness = r.sheen_roughness;
    return m;
}

// Directions in the frame whose x axis is the one of alpha.x, and back.
vec3 principled_turned(PrincipledMaterial m, vec3 w) {
#ifndef ABSENT_principled_anisotropy
    w.xy = vec2(dot(m.axis, w.xy), m.axis.x * w.y - m.axis.y * w.x);
#endif
    return w;
}
vec3 principled_turned_back(PrincipledMaterial m, vec3 w) {
#ifndef ABSENT_principled_anisotropy
    w.xy = vec2(m.axis.x * w.x - m.axis.y * w.y, m.axis.y * w.x + m.axis.x * w.y);
#endif
    return w;
}

// The material as it is for light that comes from above (side 1) or below (-1).
void principled_face(inout PrincipledMaterial m, SurfaceContext c, float side) {
    m.near = side < 0.0 ? c.ior_below : c.ior_above;
    m.eta = (side < 0.0 ? c.ior_above : c.ior_below) / m.near;
    m.diffuse_transmitted = m.sent * min(m.eta * m.eta, 1.0);
    m.diffuse_reflected = (1.0 - m.through) * m.color + (m.sent - m.diffuse_transmitted);
#if COAT_HAS_NORMAL
    m.coat_normal = principled_turned(m, vec3(side * m.coat_normal_above.xy, m.coat_normal_above.z));
#endif
}

// Directions in a frame around the normal of the coat, and back.
#if COAT_HAS_NORMAL
vec3 principled_to_coat(PrincipledMaterial m, vec3 w) { return w * frame_around(m.coat_normal); }
vec3 principled_from_coat(PrincipledMaterial m, vec3 w) { return frame_around(m.coat_normal) * w; }
float principled_coat_cosine(PrincipledMaterial m, vec3 w) { return dot(m.coat_normal, w); }
#else
#define principled_to_coat(m, w) (w)
#define principled_from_coat(m, w) (w)
#define principled_coat_cosine(m, w) (w).z
#endif
