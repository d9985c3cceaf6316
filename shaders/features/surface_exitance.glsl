// Light that leaves a surface on which a meter lies (features/surface_meters.glsl). A forward path that is about to do so first makes a
// step of no length, which brings it to the pixel, weighted against backward paths that come to the surface there.
#include "features/light_layers.glsl"
#include "features/merging.glsl"
#include "features/mis.glsl"
#include "features/polarization.glsl"
#include "features/surface_meters.glsl"
#include "features/weights.glsl"

#if HAS_SURFACE_METERS && FORWARD
// False: the path leaves no such surface.
bool leave_surface(inout Path path, inout ShadowRay shadow) {
    if (!leaves_watched(path)) return false;
    uint v = leaving_view(path);
    View view = views[v];
    ReceiverSample r = receiver_at_surface(view.receiver, path.leaves.x >> 1, (path.leaves.x & 1u) != 0u, true);
    float importance = r.density * pixel_count(view);  // of one pixel
    shadow.contribution = path.throughput * (importance * r.weight * forward_pass.path_flux);
    shadow.origin = path.origin;
    shadow.direction = path.direction;
    shadow.t_max = ALREADY_THERE;
    carry_polarization(shadow, path);
    carry_history(shadow, path);
    weigh(shadow, others_of_escape(path, importance, 0.0));
    shadow.target = pixel_of(view, r.film);
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
