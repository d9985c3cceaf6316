// What one surface does to polarization, for pairs of directions.
#include "interfaces/surface_optics.glsl"
layout(local_size_x = 64) in;

struct Query { vec3 from, to; uint event; };
layout(scalar, set = 0) readonly buffer Queries { Query queries[]; };
struct Matrix { vec3 from, to; Spectrum m[16]; };
layout(scalar, set = 0) writeonly buffer Muellers { Matrix muellers[]; };
layout(push_constant) uniform Push {
    uint count, surface;
    float ior_above, ior_below;
    uint importance;
    float color_r, color_g, color_b, color_a;
};

Mueller mueller_of(uint ref, SurfaceContext c, Query q) {
    Mueller result = depolarizing();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) \
    case tag: result = name##_mueller(name##_resolve(name##_record(record_index(ref)), c), c, q.from, q.to, q.event); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    SurfaceContext c = unbent_context(vec2(0), vec2(0), vec4(color_r, color_g, color_b, color_a), ior_above, ior_below,
                                      importance != 0u);
    Mueller m = mueller_of(surface, c, queries[i]);
    muellers[i].from = m.from, muellers[i].to = m.to;
    for (int k = 0; k < 4; ++k) {
        Stokes unit = Stokes(0);
        unit[k] = Spectrum(1);
        Stokes column = apply_mueller(unit, m, false);
        for (int row = 0; row < 4; ++row) muellers[i].m[4 * row + k] = column[row];
    }
}
