// A hit made ready to scatter: the shading frame, the media on both sides, and the checks that keep shading normals from
// letting light through. Classes of SurfaceOptics see none of this.
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/frames.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"

struct ScatteringPoint {
    mat3 frame;         // columns: tangent, bitangent, shading normal, in world space
    vec3 normal;        // geometric, unit
    vec3 wo;            // towards where the ray came from, in the shading frame
    uint surface;       // RecordRef
    uint medium_above;  // media on the side of the normal and below it
    uint medium_below;
    SurfaceContext context;
};

// The shading normal, bent by a normal map where there is one.
mat3 shading_frame(SurfacePoint p, Material m) {
    vec3 normal = p.shading_normal;
#if HAS_VERTEX_ATTRIBUTES
    mat3 frame = frame_along(normal, p.tangent.xyz, p.tangent.w);
#else
    mat3 frame = frame_around(normal);
#endif
#if HAS_NORMAL_MAPS
    if (m.normal_texture.index != NO_RECORD) {
        vec3 t = texture_value(m.normal_texture, p.uv0, p.uv1).xyz * 2.0 - 1.0;
        t.xy *= m.normal_scale;
        normal = normalize(frame * t);
        frame = frame_along(normal, frame[0], p.tangent.w);
    }
#endif
    return frame;
}

// `direction` is that of the ray that hit p, `medium` the one it came through.
ScatteringPoint scattering_point(SurfacePoint p, vec3 direction, uint medium, bool importance) {
    Material m = materials[p.material];
    ScatteringPoint s;
    s.normal = p.geometric_normal;
    s.surface = m.surface;
    s.frame = shading_frame(p, m);
    s.wo = -direction * s.frame;
    // Seen from the side that the shading normal faces away from: the surface is taken as flat there.
    if (s.wo.z * -dot(direction, s.normal) <= 0.0) {
        s.frame = frame_around(s.normal);
        s.wo = -direction * s.frame;
    }
    bool separates = (m.flags & MATERIAL_SEPARATES_MEDIA) != 0u;
    s.medium_above = separates ? m.outside : medium;
    s.medium_below = separates ? m.inside : medium;
    s.context = SurfaceContext(p.uv0, p.uv1, p.color, 1.0, 1.0, importance);
#if HAS_INTERFACES
    s.context.ior_above = medium_ior(s.medium_above);
    s.context.ior_below = medium_ior(s.medium_below);
#endif
    return s;
}

// The medium that a ray is in after it leaves in a world direction.
uint scattering_medium(ScatteringPoint s, vec3 direction) {
    return dot(direction, s.normal) > 0.0 ? s.medium_above : s.medium_below;
}
