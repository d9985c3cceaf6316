// Rays through the scene's hierarchy: the nearest hit, or any.
#include "lib/bvh.glsl"

struct Hit {
    float t;         // along the ray, in lengths of its direction
    vec2 uv;         // of the primitive's class
    uint primitive;  // entry of `primitives`; NO_RECORD = nothing was hit
    uint instance;   // entry of `primitives` of the instance that holds it; NO_RECORD = none
};

#include "features/unrolled.glsl"
