// Power, bounds and directions of every light, for the host to build the light hierarchy from
// (host/lights/light_tree.h) and for the power balance. One lane a light. Reads: lights and what they refer
// to. Writes: LightBoundsTable. Barrier expected: after the dispatch.
#include "interfaces/light_source.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint first, light_count;
};

// Mirrors struct LightBounds of light_tree.h.
struct LightBounds {
    vec3 lo;
    float power;
    vec3 hi;
    float cos_normals;
    vec3 axis;
    float cos_emission;
};

layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };
layout(scalar, set = 0) writeonly buffer LightBoundsTable { LightBounds light_bounds_table[]; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= light_count) return;
    LightBounds b;
    light_bounds(lights[i], b.lo, b.hi);
    b.power = light_power(lights[i], scene_bounds());
    LightCone cone = light_cone(lights[i]);
    b.axis = cone.axis;
    b.cos_normals = cone.cos_normals;
    b.cos_emission = cone.cos_emission;
    light_bounds_table[i] = b;
}
