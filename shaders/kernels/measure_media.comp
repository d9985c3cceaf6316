// What a medium does to light, one lane a medium: it absorbs or scatters (1), scatters (2), bends it (4), scatters the same
// everywhere (8). The classes know.
// Reads: media. Writes: one word a medium. Barrier expected: after the dispatch.
#include "interfaces/medium_optics.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) readonly buffer MediumRefs { uint medium_refs[]; };
layout(scalar, set = 0) buffer MediumEffects { uint medium_effects[]; };
layout(push_constant) uniform Push { uint first, count; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint ref = medium_refs[i];
    medium_effects[i] = (medium_is_clear(ref) ? 0u : 1u) | (medium_scatters(ref) ? 2u : 0u) | (medium_bends(ref) ? 4u : 0u) |
                        (medium_scatters(ref) && medium_is_even(ref) ? 8u : 0u);
}
