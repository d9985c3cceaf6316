// Whether a medium leaves light as it is, one lane a medium: the classes know.
// Reads: media. Writes: one word a medium. Barrier expected: after the dispatch.
#include "interfaces/medium_optics.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) readonly buffer MediumRefs { uint medium_refs[]; };
layout(scalar, set = 0) buffer MediumClarity { uint medium_clarity[]; };
layout(push_constant) uniform Push { uint first, count; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i < count) medium_clarity[i] = medium_is_clear(medium_refs[i]) ? 1u : 0u;
}
