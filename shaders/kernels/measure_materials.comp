// Whether anything passes straight through a material's surface, one lane a material: the classes know. With priorities also
// whether anything passes at all, found by sampling: what lets none pass bounds no body.
// Reads: materials. Writes: one word a material. Barrier expected: after the dispatch.
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/materials.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) buffer MaterialOpacity { uint material_is_opaque[]; };
layout(push_constant) uniform Push { uint first, count; };
const uint SURFACE_SAMPLES = 256u;  // over directions and texture coordinates

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    Material m = materials[i];
    SurfaceContext c = unbent_context(vec2(0), vec2(0), vec4(1), 1.0, 1.0, false);
    // What is around a body with a priority may have its index, even if the surface of most of it is opaque.
    if ((m.flags & MATERIAL_SEPARATES_MEDIA) != 0u && m.body == NO_RECORD)
        c.ior_above = medium_ior(m.outside, vec3(0)), c.ior_below = medium_ior(m.inside, vec3(0));
    uint answer = surface_is_opaque(m.surface, c) ? 1u : 0u;
    bool passes = HAS_PRIORITIES == 0 || m.surface == NO_RECORD;
    for (uint k = 0u; HAS_PRIORITIES == 1 && k < SURFACE_SAMPLES && !passes; ++k) {
        Sampler random = start_sampler(uvec2(0), k, 0u);
        c.uv0 = c.uv1 = sample_2d(random);
        c.ior_below = 1.5;
        BsdfSample b = surface_sample(m.surface, c, warp_sphere(sample_2d(random)), sample_3d(random));
        passes = (b.event & EVENT_TRANSMIT) != 0u;
    }
    if (!passes) answer |= 2u;
    material_is_opaque[i] = answer;
}
