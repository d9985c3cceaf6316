// Draws turns of one phase function, and asks its values for cosines.
#include "interfaces/phase_function.glsl"
#include "lib/sampler.glsl"
layout(local_size_x = 64) in;

layout(scalar, set = 0) writeonly buffer Samples { float samples[]; };  // cosines
layout(scalar, set = 0) readonly buffer Cosines { float cosines[]; };
layout(scalar, set = 0) writeonly buffer Values { Spectrum values[]; };
layout(push_constant) uniform Push { uint count, asked, seed, phase; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < asked) values[i] = phase_value(phase, cosines[i]);
    if (i >= count) return;
    // The first two are the ends of the range, which a sampler may give.
    uint bits = i == 0u ? 0u : i == 1u ? 0xFFFFFFu : hash_3d(hash_3d(uvec3(i, seed, 1u))).x >> 8;
    samples[i] = phase_sample(phase, float(bits) / 16777216.0);
}
