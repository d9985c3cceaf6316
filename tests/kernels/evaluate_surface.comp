// What one surface says of pairs of directions.
#define BIDIRECTIONAL 1
#include "interfaces/surface_optics.glsl"
layout(local_size_x = 64) in;

struct Pair { vec3 wo, wi; };
layout(scalar, set = 0) readonly buffer Pairs { Pair pairs[]; };
layout(scalar, set = 0) writeonly buffer Values { Scattering values[]; };
layout(push_constant) uniform Push {
    uint count, surface;
    float ior_above, ior_below;
    uint importance;
    float color_r, color_g, color_b, color_a;
};

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Pair p = pairs[i];
    SurfaceContext c = unbent_context(vec2(0), vec2(0), vec4(color_r, color_g, color_b, color_a), ior_above, ior_below,
                                      importance != 0u);
    values[i] = surface_pair(surface, c, p.wo, p.wi);
}
