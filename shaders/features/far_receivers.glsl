// Light that leaves the scene, for a receiver far away: what has started at a point or as a beam and met smooth surfaces alone, which
// nothing else brings.
#include "features/merging.glsl"
#include "features/polarization.glsl"
#include "features/receiver_kinds.glsl"
#include "features/weights.glsl"
#include "lib/forward_pass.glsl"
#include "lib/path.glsl"

uint pixel_of(vec2 film) {
    uvec2 size = uvec2(forward_pass.width, forward_pass.height);
    uvec2 pixel = min(uvec2(film * vec2(size)), size - 1u);
    return pixel.y * size.x + pixel.x;
}

#if HAS_FAR_RECEIVERS
void reach_far(Path path, inout ShadowRay shadow) {
    ReceiverSample r = receiver_far(forward_pass.receiver, path.direction, film_aspect());
    if ((path.flags & PATH_SMOOTH) == 0u || !(r.pdf > 0.0)) return;
    shadow.contribution = path.throughput * (r.density * r.weight * pixel_count() * forward_pass.path_flux);
    shadow.origin = path.origin;
    shadow.direction = path.direction;
    shadow.t_max = 1e-30;
    carry_polarization(shadow, path);
    weigh_alone(shadow);
    shadow.target = pixel_of(r.film);
}
#else
#define reach_far(path, shadow)
#endif
