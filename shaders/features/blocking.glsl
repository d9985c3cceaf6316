// Whether a surface lets nothing pass at all, found by sampling it: what does bounds no body (features/bodies.glsl), and is asked
// only where bodies have priorities.
#include "interfaces/surface_optics.glsl"
#include "lib/sampler.glsl"

#if HAS_PRIORITIES
const uint BLOCKING_SAMPLES = 256u;  // over directions and texture coordinates

bool blocks_all(uint surface, SurfaceContext c) {
    bool passes = surface == NO_RECORD;
    for (uint k = 0u; k < BLOCKING_SAMPLES && !passes; ++k) {
        Sampler random = start_sampler(uvec2(0), k, 0u);
        c.uv0 = c.uv1 = sample_2d(random);
        c.ior_below = 1.5;
        BsdfSample b = surface_sample(surface, c, warp_sphere(sample_2d(random)), sample_3d(random));
        passes = (b.event & EVENT_TRANSMIT) != 0u;
    }
    return !passes;
}
#else
bool blocks_all(uint surface, SurfaceContext c) { return false; }
#endif
