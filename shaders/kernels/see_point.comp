// What the receiver sees through one point of the film: one lane.
// Reads: scene. Writes: seen_point. Barrier expected: after the dispatch.
layout(local_size_x = 1) in;
layout(push_constant) uniform Push {
    uint receiver;
    float film_x, film_y;
    float aspect;
};

#include "stages/emit_camera_ray.glsl"
#include "stages/find_first.glsl"

struct SeenPoint {
    uint hit;
    vec3 position, normal;
    float distance;
    uint material;
    uint surface;
};
layout(scalar, set = 0) writeonly buffer SeenPoints { SeenPoint seen_points[]; };

void main() {
    CameraRay ray = receiver_emit(receiver, vec2(film_x, film_y), vec2(0.5), aspect);
    SeenPoint seen = SeenPoint(0u, vec3(0), vec3(0), 0.0, 0u, NO_RECORD);
    Path path = emit_camera_ray(View(receiver, 0u, 0u, 1u, 1u, views[0].element, 1.0), 0u, 0u, 0u);
    path.origin = ray.origin, path.direction = ray.direction;
    FirstHit first = find_first(path);
    SurfacePoint p = first.p;
    if (first.found)
        seen = SeenPoint(1u, p.position, p.shading_normal, first.distance, p.material, materials[p.material].surface);
    seen_points[0] = seen;
}
