// Light that leaves a surface on which a meter lies (features/surface_meters.glsl). A forward path that is about to do so first makes a
// step of no length, which brings it to the pixel, weighted against backward paths that come to the surface there.
#include "features/arriving_light.glsl"
#include "features/surface_meters.glsl"

#if HAS_SURFACE_METERS && FORWARD
// False: the path leaves no such surface.
bool leave_surface(inout Path path, inout ShadowRay shadow) {
    if (!leaves_watched(path)) return false;
    uint v = leaving_view(path);
    View view = views[v];
    ReceiverSample r = receiver_at_surface(view.receiver, path.leaves.x >> 1, path.origin, (path.leaves.x & 1u) != 0u, true);
    bring_arriving(path, view, r, 1.0, 0.0, shadow);
    path.leaves.y = v + 1u;
    if (leaving_view(path) == NO_RECORD) leave_nothing(path);
    return true;
}

// Of a path that starts at a light: the triangle that it is.
void leave_emitter(inout Path path, uint light, bool front) {
    leave_nothing(path);
#ifdef TAG_area
    if (record_tag(lights[light]) == uint(TAG_area)) leave_primitive(path, area_record(record_index(lights[light])).primitive, front);
#endif
}
#else
#define leave_surface(path, shadow) false
#define leave_emitter(path, light, front)
#endif
