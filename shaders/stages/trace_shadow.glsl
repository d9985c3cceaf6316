// Follows a shadow ray: what of its contribution reaches the point. Surfaces that let light pass straight on and absorbing media
// attenuate it; anything else blocks it, media that bend rays, too.
#include "features/straight.glsl"

Brought trace_shadow(ShadowRay shadow, inout Counters counters) {
    if (!(shadow.t_max > 0.0)) return nothing_brought();
    counters.shadow_rays++;
    return follow_shadow_ray(shadow);
}
