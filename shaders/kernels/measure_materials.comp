// Whether anything passes straight through a material's surface, one lane a material: the classes know.
// Reads: materials. Writes: one word a material. Barrier expected: after the dispatch.
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/materials.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) buffer MaterialOpacity { uint material_is_opaque[]; };
layout(push_constant) uniform Push { uint first, count; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    Material m = materials[i];
    SurfaceContext c = SurfaceContext(vec2(0), vec2(0), vec4(1), 1.0, 1.0, false);
    if ((m.flags & MATERIAL_SEPARATES_MEDIA) != 0u) c.ior_above = medium_ior(m.outside), c.ior_below = medium_ior(m.inside);
    material_is_opaque[i] = surface_is_opaque(m.surface, c) ? 1u : 0u;
}
