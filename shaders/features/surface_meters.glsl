// Meters on the surfaces of meshes (receivers/surface.glsl). What comes to a side they catch as receptors do, a hair before it: forward
// paths where they hit a triangle that is watched, so that no search is needed. What leaves a side a ray brings as it leaves the scene for
// receivers far away (features/surface_exitance.glsl).
#include "features/clearance.glsl"
#include "features/views.glsl"
#include "lib/hits.glsl"
#include "lib/materials.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"
#include "features/start_media.glsl"

#if HAS_SURFACE_METERS
// Does the ray of the view start above a surface, which light leaves along it?
bool starts_at_surface(View view, CameraRay ray) { return on_surface(view.receiver) && !ray.at_receptor; }

// What the ray of a point of the film starts in.
Surroundings around_ray(View view, vec2 film) {
    if (HAS_INTERFACES == 1 && on_surface(view.receiver)) {
        bool front;
        Material m = materials[primitives[receiver_face(view.receiver, film, front)].material];
        if ((m.flags & MATERIAL_SEPARATES_MEDIA) != 0u) return surroundings_of(front ? m.outside : m.inside);
    }
    return around_receiver(view);
}

// A sample of a pixel, kept off its edges by what the film's coordinates round: pixels beside each other are of different triangles.
vec2 within_pixel(View view, vec2 u) { return on_surface(view.receiver) ? clamp(u, 0.001, 0.999) : u; }

#if FORWARD
bool is_watched(View view, uint primitive) {
    return on_surface(view.receiver) && receiver_at_surface(view.receiver, primitive, vec3(0), true, false).pdf > 0.0;
}

// The view that catches the path where it has hit a triangle; NO_RECORD = none, or it has done so.
uint watching_view(Path path, Hit hit) {
    if (hit.primitive == NO_RECORD || hit.instance != NO_RECORD) return NO_RECORD;
    for (uint v = 0u; v < VIEW_COUNT; ++v)
        if ((path.flags >> (PATH_PASSED_SHIFT + v) & 1u) == 0u && is_watched(views[v], hit.primitive)) return v;
    return NO_RECORD;
}

// Where it is caught: in the picture.
ReceiverSample caught_at_surface(Path path, View view, Hit hit) {
    bool front = dot(path.direction, triangle_normal(primitives[hit.primitive])) < 0.0;
    return receiver_at_surface(view.receiver, hit.primitive, path.origin + hit.t * path.direction, front, false);
}

// How far above what the path has hit it is sure to hit it again, m.
float height_above(SurfacePoint p, Hit hit) {
    return clearance(primitives[hit.primitive], p.position) + dot(abs(p.geometric_normal), 4.0 * p.error);
}

// The path has come to what it has hit: it may be caught at the next hit.
void forget_watched(inout Path path) {
    for (uint v = 0u; v < VIEW_COUNT; ++v)
        if (on_surface(views[v].receiver)) path.flags &= ~(1u << (PATH_PASSED_SHIFT + v));
}

// The next view, from path.leaves.y on, that watches the triangle that the path leaves.
uint leaving_view(Path path) {
    for (uint v = path.leaves.y; v < VIEW_COUNT; ++v)
        if (is_watched(views[v], path.leaves.x >> 1)) return v;
    return NO_RECORD;
}

void leave_nothing(inout Path path) { path.leaves = uvec2(NO_RECORD, 0u); }

// The path's next ray leaves a side of the primitive.
void leave_primitive(inout Path path, uint primitive, bool front) {
    path.leaves = uvec2(primitive << 1 | uint(front), 0u);
    if (leaving_view(path) == NO_RECORD) leave_nothing(path);
}

bool leaves_watched(Path path) { return path.leaves.x != NO_RECORD; }
#endif

#else
#define starts_at_surface(view, ray) false
#define around_ray(view, film) around_receiver(view)
#define within_pixel(view, u) (u)
#endif

#if !HAS_SURFACE_METERS || !FORWARD
#define watching_view(path, hit) NO_RECORD
#define caught_at_surface(path, view, hit) no_receiver_sample()
#define forget_watched(path)
#define height_above(p, hit) 0.0
#define leave_nothing(path)
#define leave_primitive(path, primitive, front)
#define leaves_watched(path) false
#endif
