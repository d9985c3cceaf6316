// Steps of bent rays through a medium of a scene, one lane a ray.
#include "lib/bent_ray.glsl"
layout(local_size_x = 64) in;

struct Start { vec3 position, direction; };
struct Step { vec3 position; BentStep step; };
layout(scalar, set = 0) readonly buffer Starts { Start starts[]; };
layout(scalar, set = 0) writeonly buffer Steps { Step steps[]; };  // of a ray one after the other
layout(push_constant) uniform Push { uint count, steps_a_ray, medium; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 position = starts[i].position, direction = starts[i].direction;
    for (uint k = 0u; k < steps_a_ray; ++k) {
        BentStep s = bent_step(medium, position, direction, INFINITY);
        steps[i * steps_a_ray + k] = Step(position, s);
        position += s.chord;
        direction = normalize(s.end);
    }
}
