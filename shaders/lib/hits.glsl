// What the rays of a queue have hit, ray by ray.
#include "lib/traversal.glsl"

layout(scalar, set = 0) buffer Hits { Hit hits[]; };
