// Follows a shadow ray: what of its contribution reaches the point. Surfaces that let light pass straight on (alpha,
// index-matched boundaries, thin glass) and absorbing media attenuate it; anything else blocks it, media that bend rays, too.
#include "lib/path.glsl"
#include "lib/scattering.glsl"
#include "lib/traversal.glsl"

// A number for the ray that no other has, for media that need random numbers.
uint shadow_seed(ShadowRay shadow) {
    uvec3 where = hash_3d(floatBitsToUint(shadow.origin)), how = floatBitsToUint(shadow.direction);
    return hash_3d(hash_3d(where ^ how) ^ floatBitsToUint(vec3(shadow.contribution[0], shadow.contribution[1], shadow.t_max))).x;
}

// Through the medium that the ray is in.
void pass_medium(inout ShadowRay shadow, float distance) {
#if HAS_MEDIA
    if (shadow.medium == NO_RECORD) return;
    Passage passage = medium_pass(shadow.medium, MediumRay(shadow.origin, shadow.direction, distance), shadow_seed(shadow));
    shadow.contribution *= passage.transmittance;
#if HAS_SCATTERING
    if (medium_scatters(shadow.medium)) shadow.others *= passage.mean;
#endif
#endif
}

Spectrum weighed(ShadowRay shadow) {
#if HAS_SCATTERING
#if BEAMS
    shadow.others += shadow.others_apart;
#endif
    return shadow.contribution * mis_weight(shadow.others);
#else
    return shadow.contribution;
#endif
}

Spectrum trace_shadow(ShadowRay shadow, inout Counters counters) {
    if (!(shadow.t_max > 0.0)) return Spectrum(0);
    counters.shadow_rays++;
#if !HAS_STRAIGHT && !HAS_MEDIA
    return find_occlusion(shadow.origin, shadow.direction, shadow.t_max) ? Spectrum(0) : shadow.contribution;
#elif !HAS_STRAIGHT
    if (find_occlusion(shadow.origin, shadow.direction, shadow.t_max)) return Spectrum(0);
    pass_medium(shadow, shadow.t_max);
    return weighed(shadow);
#else
    float t_left = shadow.t_max;
    while (true) {
        Hit hit = find_hit(shadow.origin, shadow.direction, t_left);
        bool met = hit.primitive != NO_RECORD;
        pass_medium(shadow, met ? hit.t : t_left);
        if (!met) return weighed(shadow);
        SurfacePoint p = locate(hit, shadow.origin, shadow.direction);
#if HAS_PRIORITIES
        Crossing crossing = meet_faces(shadow.origin, shadow.direction, shadow.bodies, hit, p);
        if (crossing.is_there) {
            if ((materials[p.material].flags & MATERIAL_OPAQUE) != 0u) return Spectrum(0);
            ScatteringPoint s = scattering_point(p, shadow.direction, medium_above(crossing, p, shadow.direction));
            shadow.contribution *= surface_transparency(s.surface, s.context, s.wo);
            if (is_black(shadow.contribution)) return Spectrum(0);
        }
        shadow.bodies = crossing.after;
#else
        if ((materials[p.material].flags & MATERIAL_OPAQUE) != 0u) return Spectrum(0);
        ScatteringPoint s = scattering_point(p, shadow.direction, shadow.medium);
        shadow.contribution *= surface_transparency(s.surface, s.context, s.wo);
        if (is_black(shadow.contribution)) return Spectrum(0);
#endif
        vec3 origin = origin_behind(shadow.origin, p.position, p.error, p.geometric_normal, shadow.direction);
        t_left = t_left < INFINITY ? t_left - dot(origin - shadow.origin, shadow.direction) : INFINITY;
        if (!(t_left > 0.0)) return weighed(shadow);
        shadow.origin = origin;
#if HAS_PRIORITIES
        shadow.medium = medium_among(shadow.bodies);
#else
        shadow.medium = scattering_medium(s, shadow.direction);
#endif
#if HAS_BENDING
        if (medium_bends(shadow.medium)) return Spectrum(0);
#endif
    }
#endif
}
