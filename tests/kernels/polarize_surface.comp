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
        ALL_SURFACE_CLASSES(CASE)
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
    const Spectrum none = Spectrum(0);
    muellers[i].from = m.from, muellers[i].to = m.to;
    Spectrum rows[16] = Spectrum[16](Spectrum(1), m.b, none, none, m.b, m.e, none, none, none, none, m.c, -m.d, none, none, m.d, m.c);
    for (uint k = 0u; k < 16u; ++k) muellers[i].m[k] = m.is_general ? m.m[k] : rows[k];
}
