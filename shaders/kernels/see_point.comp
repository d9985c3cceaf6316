// What the receiver sees through one point of the film: one lane.
// Reads: scene. Writes: seen_point. Barrier expected: after the dispatch.
layout(local_size_x = 1) in;
layout(push_constant) uniform Push {
    uint receiver;
    float film_x, film_y;
    float film_aspect;
};

#include "interfaces/receiver.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"
#include "lib/traversal.glsl"

struct SeenPoint {
    uint hit;
    vec3 position, normal;
    float distance;
    uint material;
    uint surface;
};
layout(scalar, set = 0) writeonly buffer SeenPoints { SeenPoint seen_points[]; };

void main() {
    CameraRay ray = receiver_emit(receiver, vec2(film_x, film_y), film_aspect);
    Hit hit = find_hit(ray.origin, ray.direction, INFINITY);
    SeenPoint seen = SeenPoint(0u, vec3(0), vec3(0), 0.0, 0u, NO_RECORD);
    if (hit.primitive != NO_RECORD) {
        SurfacePoint p = locate(hit, ray.origin, ray.direction);
        seen = SeenPoint(1u, p.position, p.shading_normal, hit.t, p.material, materials[p.material].surface);
    }
    seen_points[0] = seen;
}
