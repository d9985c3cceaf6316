// Frames about the normal that directions are scattered about: of the mesh, and as a normal map bends it.
#include "interfaces/surface_optics.glsl"
#include "lib/frames.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"

// Around the interpolated normal. Along the tangent only where something asks for it.
mat3 mesh_frame(SurfacePoint p) {
#if HAS_VERTEX_ATTRIBUTES || defined(SURFACES_HAVE_TANGENTS)
    return frame_along(p.shading_normal, p.tangent.xyz, p.tangent.w);
#else
    return frame_around(p.shading_normal);
#endif
}

#if HAS_NORMAL_MAPS
// The mesh's frame, bent by a normal map where there is one.
mat3 bent_frame(mat3 frame, SurfacePoint p, Material m) {
    if (m.normal_texture.index == NO_RECORD) return frame;
    vec3 t = texture_value(m.normal_texture, p.uv0, p.uv1).xyz * 2.0 - 1.0;
    t.xy *= m.normal_scale;
    return frame_along(normalize(frame * t), frame[0], p.tangent.w);
}
#else
#define bent_frame(frame, p, m) frame
#endif

// The mesh's frame, for classes that ask for it.
#if HAS_NORMAL_MAPS && defined(SURFACES_USE_MESH_FRAME)
void keep_mesh_frame(inout SurfaceContext c, mat3 frame, mat3 unbent) { c.mesh_frame = transpose(frame) * unbent; }
#else
#define keep_mesh_frame(c, frame, unbent)
#endif
