// The film's mean radiance, one lane a pixel; black before the first pass.
// Reads: film. Writes: picture. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint pixels;
    float weight;  // 1 / passes; 0 before the first
};

#include "lib/film.glsl"

layout(scalar, set = 0) writeonly buffer Picture { vec3 picture[]; };

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < pixels; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x)
        picture[i] = (rounded(film[film_place(i, 0u, 0u)].sum) + rounded(film[film_place(i, 0u, 1u)].sum)) * weight;
}
