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
#if HAS_BENDING || HAS_PRIORITIES
#include "stages/emit_camera_ray.glsl"
#include "stages/find_first.glsl"
#endif

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
    SeenPoint seen = SeenPoint(0u, vec3(0), vec3(0), 0.0, 0u, NO_RECORD);
#if HAS_BENDING || HAS_PRIORITIES
    Path path = emit_camera_ray(receiver, uvec2(0), uvec2(1), 0u, 0u);
    path.origin = ray.origin, path.direction = ray.direction;
    FirstHit first = find_first(path);
    bool found = first.found;
    SurfacePoint p = first.p;
    float distance = first.distance;
#else
    Hit hit = find_hit(ray.origin, ray.direction, INFINITY);
    bool found = hit.primitive != NO_RECORD;
    SurfacePoint p;
    if (found) p = locate(hit, ray.origin, ray.direction);
    float distance = hit.t;
#endif
    if (found) seen = SeenPoint(1u, p.position, p.shading_normal, distance, p.material, materials[p.material].surface);
    seen_points[0] = seen;
}
