// Receivers far away see light that leaves the scene: the last ray of a forward path brings it, weighted against connections to
// them and against backward paths, which alone would have to hit a lamp from afar.
#include "features/arriving_light.glsl"

#if HAS_FAR_RECEIVERS && FORWARD
void reach_far(inout Path path, inout ShadowRay shadow) {
    uint v = choose_view(path.random);
    if (v == NO_RECORD) return;
    View view = views[v];
    ReceiverSample r = receiver_far(view.receiver, path.direction, film_aspect(view));
    if (r.pdf > 0.0) bring_arriving(path, view, r, view.share, r.pdf, shadow);
}
#else
#define reach_far(path, shadow)
#endif
