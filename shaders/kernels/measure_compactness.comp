// Whether a light is compact, one lane a light: asked of the classes by sampling it from points in the scene. The solid angle
// under which it is seen is the reciprocal of its mean density; lights that share the power share an angle. Backward rays that
// leave a surface by chance, or by its law of reflection, seldom find a compact light. One that none of the points sees sends a
// narrow beam. In a medium points and narrow beams are more than compact: what scatters next to a point, where light is bright
// without bound, or within a beam, backward rays meet by chance alone.
// Reads: lights. Writes: one word a light, compact (1), a point or a narrow beam (2). Barrier expected: after the dispatch.
#include "interfaces/light_source.glsl"
#include "features/light_emission.glsl"
#include "lib/sampler.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };
layout(scalar, set = 0) buffer LightCompactness { uint light_is_compact[]; };
layout(push_constant) uniform Push { uint first, count; };

const float COMPACT_ANGLE = 0.6;  // sr, a twentieth of the sphere
const uint VIEWS = 64u;

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    bool is_delta = false, is_point = false;
    float density = 0.0, views = 0.0;
    for (uint k = 0u; k < VIEWS; ++k) {
        Sampler random = start_sampler(uvec2(0), k, 0u);
        vec3 point = warp_sphere(sample_2d(random)) * (scene_bounds().radius * 0.8 * sample_1d(random));
        LightSample l = light_sample_towards(lights[i], point, sample_2d(random));
        if (!(l.pdf > 0.0) || is_black(l.radiance)) continue;
        is_delta = is_delta || l.is_delta;
        is_point = is_point || (l.is_delta && l.distance < INFINITY);
        density += l.pdf;
        views += 1.0;
    }
    float share = emitter_probability(i);
    bool is_compact = is_delta || views <= density * COMPACT_ANGLE * share;
    light_is_compact[i] = share > 0.0 ? (is_compact ? 1u : 0u) | (is_point || views == 0.0 ? 2u : 0u) : 0u;
}
