// Facets of the class `principled` that are wider one way than across it. Widths of GGX are one number where no material of the
// scene has such.
#include "lib/accurate_math.glsl"
#include "lib/microfacet_anisotropic.glsl"

#ifndef ABSENT_principled_anisotropy
#define SURFACES_HAVE_TANGENTS  // features/normal_maps.glsl: frames follow the surface's tangent
#define PrincipledWidth vec2
const uint PRINCIPLED_WIDTHS = 2u;
float principled_width(PrincipledWidth alpha, uint i) { return i == 0u ? alpha.x : alpha.y; }

void resolve_anisotropy(inout Principled r, SurfaceContext c) {
    if (r.anisotropy_texture.index == NO_RECORD) return;
    vec3 t = texture_value(r.anisotropy_texture, c.uv0, c.uv1).xyz;
    r.anisotropy *= t.z;
    r.anisotropy_rotation += accurate_atan2(2.0 * t.y - 1.0, 2.0 * t.x - 1.0);
}

// The widest is the first, along the axis, which lies in the local xy plane.
PrincipledWidth principled_widths(Principled r, float width, out vec2 axis) {
    PrincipledWidth alpha = vec2(width);
    if (r.anisotropy > 0.0) {
        alpha.y = max(width, SMOOTH_ALPHA);
        alpha.x = mix(alpha.y, 1.0, square(min(r.anisotropy, 1.0)));
    }
    axis = cos_sin_turns(r.anisotropy_rotation * (0.5 * INV_PI));
    return alpha;
}

// Directions in the frame whose x axis is that one, and back.
vec3 turned_to_axis(vec2 axis, vec3 w) { return vec3(dot(axis, w.xy), axis.x * w.y - axis.y * w.x, w.z); }
vec3 turned_from_axis(vec2 axis, vec3 w) { return vec3(axis.x * w.x - axis.y * w.y, axis.y * w.x + axis.x * w.y, w.z); }

#else
#define PrincipledWidth float
const uint PRINCIPLED_WIDTHS = 1u;
float principled_width(PrincipledWidth alpha, uint i) { return alpha; }
#define resolve_anisotropy(r, c)
PrincipledWidth principled_widths(Principled r, float width, out vec2 axis) {
    axis = vec2(1, 0);
    return width;
}
#define turned_to_axis(axis, w) (w)
#define turned_from_axis(axis, w) (w)
#endif
