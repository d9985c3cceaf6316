// What a medium does to light, one lane a medium: nothing, or it absorbs, or it scatters. The classes know.
// Reads: media. Writes: one word a medium. Barrier expected: after the dispatch.
#include "interfaces/medium_optics.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) readonly buffer MediumRefs { uint medium_refs[]; };
layout(scalar, set = 0) buffer MediumEffects { uint medium_effects[]; };
layout(push_constant) uniform Push { uint first, count; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i < count) medium_effects[i] = medium_scatters(medium_refs[i]) ? 2u : medium_is_clear(medium_refs[i]) ? 0u : 1u;
}
