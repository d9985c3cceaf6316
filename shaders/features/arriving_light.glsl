// Light of a forward path that comes to a receiver by itself, without a connection: it leaves the scene (features/far_receivers.glsl), or
// a surface on which a meter lies (features/surface_exitance.glsl).
#include "features/light_layers.glsl"
#include "features/merging.glsl"
#include "features/mis.glsl"
#include "features/polarization.glsl"
#include "features/views.glsl"
#include "features/weights.glsl"
#include "lib/path.glsl"

#if (HAS_FAR_RECEIVERS || HAS_SURFACE_METERS) && FORWARD
// The shadow ray that brings all of it. `share`: of such light that is brought to this view; `connecting`: density of connections
// that choose the same, 1/sr.
void bring_arriving(Path path, View view, ReceiverSample r, float share, float connecting, inout ShadowRay shadow) {
    float importance = r.density * pixel_count(view) / share;  // of one pixel
    shadow.contribution = path.throughput * (importance * r.weight * forward_pass.path_flux);
    shadow.origin = path.origin;
    shadow.direction = path.direction;
    shadow.t_max = ALREADY_THERE;
    carry_polarization(shadow, path);
    carry_history(shadow, path);
    weigh(shadow, others_of_escape(path, importance, connecting));
    shadow.target = pixel_of(view, r.film);
}
#endif
