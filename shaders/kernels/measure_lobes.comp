// Whether a material scatters into narrow lobes, one lane a material: asked of the classes by sampling them. Narrow is what is
// perfectly smooth or holds a density above 100/sr (GGX: alpha below about 0.03): neither light sampling nor scattering by chance
// finds a small light through it.
// Reads: materials. Writes: one word a material. Barrier expected: after the dispatch.
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "features/bodies.glsl"
#include "lib/materials.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) buffer MaterialLobes { uint material_is_narrow[]; };
layout(push_constant) uniform Push { uint first, count; };

const float NARROW_DENSITY = 100.0;  // 1/sr
const uint LOBE_SAMPLES = 256u;      // over directions and texture coordinates

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    Material m = materials[i];
    bool is_narrow = false;
    for (uint k = 0u; k < LOBE_SAMPLES && m.surface != NO_RECORD; ++k) {
        Sampler random = start_sampler(uvec2(0), k, 0u);
        vec2 uv = sample_2d(random);
        SurfaceContext c = unbent_context(uv, uv, vec4(1), 1.0, 1.0, false);
        if ((m.flags & MATERIAL_SEPARATES_MEDIA) != 0u)
            c.ior_above = medium_ior(m.outside, vec3(0)), c.ior_below = medium_ior(m.inside, vec3(0));
        // A body with a priority has vacuum around it, or any of the others.
        uint around = k % (BODIES + 1u);
        if (BODIES > 0u && m.body != NO_RECORD && around > 0u) c.ior_above = medium_ior(body_medium(around - 1u), vec3(0));
        BsdfSample b = surface_sample(m.surface, c, warp_sphere(sample_2d(random)), sample_3d(random));
        bool is_delta = (b.event & EVENT_DELTA) != 0u && (b.event & EVENT_STRAIGHT) == 0u;
        is_narrow = is_narrow || (b.event != EVENT_NONE && !is_black(b.weight) && (is_delta || b.pdf > NARROW_DENSITY));
    }
    material_is_narrow[i] = is_narrow ? 1u : 0u;
}
