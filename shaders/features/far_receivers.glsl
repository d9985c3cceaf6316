// Receivers far away see light that leaves the scene. Where it has started at a point or as a beam, and met smooth surfaces alone,
// nothing else brings it.
#include "features/merging.glsl"
#include "features/polarization.glsl"
#include "features/receiver_kinds.glsl"
#include "features/weights.glsl"
#include "lib/path.glsl"

#if HAS_FAR_RECEIVERS && FORWARD
void start_smooth(inout Path path, bool is_delta) { path.flags |= is_delta ? PATH_SMOOTH : 0u; }
void keep_smooth(inout Path path, uint event) {
    if ((event & EVENT_DELTA) == 0u) path.flags &= ~PATH_SMOOTH;
}

void reach_far(Path path, inout ShadowRay shadow) {
    ReceiverSample r = receiver_far(forward_pass.receiver, path.direction, film_aspect());
    if ((path.flags & PATH_SMOOTH) == 0u || !(r.pdf > 0.0)) return;
    shadow.contribution = path.throughput * (r.density * r.weight * pixel_count() * forward_pass.path_flux);
    shadow.origin = path.origin;
    shadow.direction = path.direction;
    shadow.t_max = ALREADY_THERE;
    carry_polarization(shadow, path);
    weigh_alone(shadow);
    shadow.target = pixel_of(r.film);
}
#else
#define start_smooth(path, is_delta)
#define keep_smooth(path, event)
#define reach_far(path, shadow)
#endif
