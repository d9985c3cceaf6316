// Local boxes of analytic shapes, one lane a shape: their classes know their extent.
// Reads: shape_refs. Writes: shape_bounds. Barrier expected: after the dispatch.
#include "interfaces/geometry.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0) readonly buffer ShapeRefs { uint shape_refs[]; };
layout(scalar, set = 0) buffer ShapeBounds { vec3 shape_bounds[]; };
layout(push_constant) uniform Push { uint first, count; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 lo, hi;
    geometry_bounds(shape_refs[i], lo, hi);
    shape_bounds[2u * i] = lo;
    shape_bounds[2u * i + 1u] = hi;
}
