// Receivers far away see light that leaves the scene: the last ray of a forward path brings it, weighted against connections to
// them and against backward paths, which alone would have to hit a lamp from afar.
#include "features/light_layers.glsl"
#include "features/merging.glsl"
#include "features/mis.glsl"
#include "features/polarization.glsl"
#include "features/weights.glsl"
#include "lib/path.glsl"

#if HAS_FAR_RECEIVERS && FORWARD
void reach_far(inout Path path, inout ShadowRay shadow) {
    uint v = choose_view(path.random);
    if (v == NO_RECORD) return;
    View view = views[v];
    ReceiverSample r = receiver_far(view.receiver, path.direction, film_aspect(view));
    if (!(r.pdf > 0.0)) return;
    float importance = r.density * pixel_count(view) / view.share;  // of one pixel
    shadow.contribution = path.throughput * (importance * r.weight * forward_pass.path_flux);
    shadow.origin = path.origin;
    shadow.direction = path.direction;
    shadow.t_max = ALREADY_THERE;
    carry_polarization(shadow, path);
    carry_history(shadow, path);
    weigh(shadow, others_of_escape(path, importance, r.pdf));
    shadow.target = pixel_of(view, r.film);
}
#else
#define reach_far(path, shadow)
#endif
