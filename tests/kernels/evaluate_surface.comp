// eval and pdf of one surface for pairs of directions.
#include "interfaces/surface_optics.glsl"
layout(local_size_x = 64) in;

struct Pair { vec3 wo, wi; };
layout(scalar, set = 0) readonly buffer Pairs { Pair pairs[]; };
layout(scalar, set = 0) writeonly buffer Values { vec4 values[]; };
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
    SurfaceContext c = SurfaceContext(vec2(0), vec2(0), vec4(color_r, color_g, color_b, color_a), ior_above, ior_below,
                                      importance != 0u);
    values[i] = vec4(surface_eval(surface, c, p.wo, p.wi), surface_pdf(surface, c, p.wo, p.wi));
}
