// Draws samples of one surface for one wo.
#include "interfaces/surface_optics.glsl"
#include "lib/sampler.glsl"
layout(local_size_x = 64) in;

struct Sample { vec3 wi; float pdf; vec3 weight; uint event; };
layout(scalar, set = 0) writeonly buffer Samples { Sample samples[]; };
layout(scalar, set = 0) writeonly buffer Answers { vec4 answers[]; };  // transparency, is_delta and 2 is_opaque
layout(push_constant) uniform Push {
    uint count, seed, surface;
    float wo_x, wo_y, wo_z, ior_above, ior_below;
    uint importance;
    float color_r, color_g, color_b, color_a;
};

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 wo = vec3(wo_x, wo_y, wo_z);
    SurfaceContext c = unbent_context(vec2(0), vec2(0), vec4(color_r, color_g, color_b, color_a), ior_above, ior_below,
                                      importance != 0u);
    // The first numbers are the ends of the range, which a sampler may give.
    vec3 u = vec3(hash_3d(hash_3d(uvec3(i, seed, 1u))) >> 8) / 16777216.0;
    const float last = 16777215.0 / 16777216.0;
    if (i < 8u) u = vec3((i & 1u) != 0u ? last : 0.0, (i & 2u) != 0u ? last : 0.0, (i & 4u) != 0u ? last : 0.0);
    BsdfSample s = surface_sample(surface, c, wo, u);
    samples[i] = Sample(s.wi, s.pdf, s.weight, s.event);
    if (i == 0u)
        answers[0] = vec4(surface_transparency(surface, c, wo), (surface_is_delta(surface, c) ? 1.0 : 0.0) +
                                                                    (surface_is_opaque(surface, c) ? 2.0 : 0.0));
}
