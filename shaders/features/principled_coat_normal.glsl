// Coats of the class `principled` with a normal of their own.
#include "lib/frames.glsl"

#ifndef ABSENT_principled_clearcoat_normal_scale
#define SURFACES_USE_MESH_FRAME  // features/normal_maps.glsl
#ifndef SURFACES_HAVE_TANGENTS
#define SURFACES_HAVE_TANGENTS
#endif

void resolve_coat_normal(inout Principled r, SurfaceContext c) {
    if (r.clearcoat_normal_scale == 0.0) return;
    vec3 n = r.clearcoat_normal;
    if (r.clearcoat_normal_texture.index != NO_RECORD)
        n = 2.0 * texture_value(r.clearcoat_normal_texture, c.uv0, c.uv1).xyz - 1.0;
    n.xy *= r.clearcoat_normal_scale;
    n = from_mesh_frame(c, n);
    r.clearcoat_normal = n.z > 0.0 ? normalize(n) : vec3(0, 0, 1);
}

// Directions in a frame around the normal of the coat, and back.
vec3 to_coat(vec3 normal, vec3 w) { return w * frame_around(normal); }
vec3 from_coat(vec3 normal, vec3 w) { return frame_around(normal) * w; }
float coat_cosine(vec3 normal, vec3 w) { return dot(normal, w); }
// Whether a direction in that frame, or by that cosine, is above the coat.
bool is_above_coat(float cosine) { return cosine > 0.0; }
// Whether the coat reflects elsewhere than the facets.
bool coat_is_apart(vec3 normal) { return any(notEqual(normal.xy, vec2(0))); }

// What the coat reflects to below the surface is mirrored there, as at normals of the mesh (features/shading_normals.glsl): the
// second of two ways for the light, whose direction is wo where paths carry power, else wi.
#define COAT_WAYS 2u
vec3 coat_way(uint way, bool is_light, vec3 w) { return way == 1u && is_light ? vec3(w.xy, -w.z) : w; }

// The coat's f times the cosine that belongs to the direction of light, about its own normal; what the caller multiplies
// by is about z, and forward rays meet the surface with that cosine (Veach 1997, section 5.3.2).
float coat_correction(vec3 normal, bool importance, vec3 wo, vec3 wi) {
    if (!importance) return 1.0;
    return coat_cosine(normal, wo) * wi.z / max(coat_cosine(normal, wi) * abs(wo.z), 1e-6);
}

// What passes the layers on the way of light, by what they let pass along its two directions. Of a coat that faces elsewhere the
// camera's direction counts alone, as KHR_materials_clearcoat says: the lesser of both would lose what neither reflects. Where its
// normals lean to all sides alike, forward rays gain by it as much as they lose.
float pass_layers(vec3 normal, bool importance, float along_wo, float along_wi) {
    return coat_is_apart(normal) ? (importance ? along_wi : along_wo) : min(along_wo, along_wi);
}
#else
#define resolve_coat_normal(r, c)
#define to_coat(normal, w) (w)
#define from_coat(normal, w) (w)
#define coat_cosine(normal, w) (w).z
#define is_above_coat(cosine) true
#define coat_is_apart(normal) false
#define COAT_WAYS 1u
#define coat_way(way, is_light, w) (w)
#define pass_layers(normal, importance, along_wo, along_wi) min(along_wo, along_wi)
#define coat_correction(normal, importance, wo, wi) 1.0
#endif
