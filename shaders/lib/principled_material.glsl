// The material of the class `principled` (surfaces/principled.glsl) at one point.
#include "features/principled_iridescence.glsl"
#include "lib/frames.glsl"
#include "lib/fresnel.glsl"
#include "lib/sheen.glsl"
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
    vec3 coat_normal_above;  // local, on the side of +z,
    vec3 coat_normal;        //   and as it is for light from the side of wo, turned
    Spectrum sheen;
    float sheen_most;   // greatest of it
    float sheen_roughness;
    PrincipledFilm film;
};

// What alpha leaves of the surface.
float covered_part(Principled r, float alpha) {
    alpha = clamp(alpha, 0.0, 1.0);
    return r.alpha_mode == 0u ? 1.0 : r.alpha_mode == 1u ? (alpha < r.alpha_cutoff ? 0.0 : 1.0) : alpha;
}

PrincipledMaterial principled_material(Principled r, SurfaceContext c) {
    PrincipledMaterial m;
    m.coverage = covered_part(r, r.base_color.a);
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
    m.alpha = principled_widths(r, square(clamp(r.roughness, 0.0, 1.0)), m.axis);
    float width = principled_width(m.alpha, 0u);
    m.smooth_facets = width < SMOOTH_ALPHA || (!m.thin && m.transmitter > 0.0 &&
                                               interface_is_smooth(width, c.ior_above, c.ior_below));
    m.importance = c.importance;
    m.through = clamp(r.diffuse_transmission, 0.0, 1.0);
    m.sent *= m.through;
    m.film = principled_film(r, m.f0 / max(m.f90, 1e-6), m.color);
    m.coat = clamp(r.clearcoat, 0.0, 1.0);
    m.coat_alpha = square(clamp(r.clearcoat_roughness, 0.0, 1.0));
    m.coat_normal_above = m.coat_normal = r.clearcoat_normal;
    m.sheen_most = max_component(m.sheen), m.sheen_roughness = r.sheen_roughness;
    return m;
}

// Directions in the frame whose x axis is the one of alpha.x, and back.
vec3 principled_turned(PrincipledMaterial m, vec3 w) { return turned_to_axis(m.axis, w); }
vec3 principled_turned_back(PrincipledMaterial m, vec3 w) { return turned_from_axis(m.axis, w); }

// The material as it is for light that comes from above (side 1) or below (-1).
void principled_face(inout PrincipledMaterial m, SurfaceContext c, float side) {
    m.near = side < 0.0 ? c.ior_below : c.ior_above;
    m.eta = (side < 0.0 ? c.ior_above : c.ior_below) / m.near;
    m.diffuse_transmitted = m.sent * min(m.eta * m.eta, 1.0);
    m.diffuse_reflected = (1.0 - m.through) * m.color + (m.sent - m.diffuse_transmitted);
    m.coat_normal = principled_turned(m, vec3(side * m.coat_normal_above.xy, m.coat_normal_above.z));
}
