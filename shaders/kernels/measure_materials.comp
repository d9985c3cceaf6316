// Whether anything passes straight through a material's surface, one lane a material: the classes know. With priorities also
// whether anything passes at all, found by sampling: what lets none pass bounds no body.
// Reads: materials. Writes: one word a material. Barrier expected: after the dispatch.
#include "features/blocking.glsl"
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
    SurfaceContext c = unbent_context(vec2(0), vec2(0), vec4(1), 1.0, 1.0, false);
    // What is around a body with a priority may have its index, even if the surface of most of it is opaque.
    if ((m.flags & MATERIAL_SEPARATES_MEDIA) != 0u && m.body == NO_RECORD)
        c.ior_above = medium_ior(m.outside, vec3(0)), c.ior_below = medium_ior(m.inside, vec3(0));
    uint answer = surface_is_opaque(m.surface, c) ? 1u : 0u;
    if (blocks_all(m.surface, c)) answer |= 2u;
    material_is_opaque[i] = answer;
}
