// Surfaces that let light pass straight on: alpha, index-matched boundaries, thin glass. Shadow rays go through.
#include "features/bending.glsl"
#include "features/light_layers.glsl"
#include "features/polarization.glsl"
#include "features/weights.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"
#include "lib/traversal.glsl"

#if HAS_MEDIA
// A number for the ray that no other has, for media that need random numbers.
uint shadow_seed(ShadowRay shadow) {
    uvec3 where = hash_3d(floatBitsToUint(shadow.origin)), how = floatBitsToUint(shadow.direction);
    return hash_3d(hash_3d(where ^ how) ^ floatBitsToUint(vec3(shadow.contribution[0], shadow.contribution[1], shadow.t_max))).x;
}

// Through the medium that the ray is in.
void pass_medium(inout ShadowRay shadow, float distance) {
    if (shadow.around.medium == NO_RECORD) return;
    MediumRay ray = MediumRay(shadow.origin, shadow.direction, distance, 0u);
    Passage passage = medium_pass(shadow.around.medium, ray, shadow_seed(shadow));
    shadow.contribution *= passage.transmittance;
    lessen_others(shadow, passage.mean);
}
#else
#define pass_medium(shadow, distance)
#endif

// Whether all of a shadow ray's way is one search for a hit, any hit.
const bool SHADOWS_ARE_SEARCHES = HAS_STRAIGHT == 0 && HAS_MEDIA == 0;

#if HAS_STRAIGHT
// Where a ray goes on behind a surface.
#define origin_of_next(path, p, direction, straight)                                                           \
    (straight ? origin_behind(path.origin, p.position, p.error, p.geometric_normal, direction)                 \
              : offset_origin(p.position, p.error, p.geometric_normal, direction))

// What of the ray's contribution reaches its end. Each surface puts the ray a little beside its way, by the error bound along the
// normal: it is aimed at its end again, or a light that it meets at a grazing angle would hide itself.
Brought follow_shadow_ray(ShadowRay shadow) {
    float t_left = shadow.t_max;
    locate_ray(shadow.location);
    vec3 direction = shadow.direction;
    while (true) {
        Hit hit = find_hit(shadow.origin, direction, t_left);
        bool met = hit.primitive != NO_RECORD;
        pass_medium(shadow, met ? hit.t : t_left);
        if (!met) return brought_by(shadow, analysed(shadow, weighed(shadow)));
        SurfacePoint p = locate(hit, shadow.origin, direction);
        Crossing sides = meet_faces(shadow.origin, direction, shadow.around, hit, p);
        if (is_there(sides)) {
            Material m = materials[p.material];
            if ((m.flags & MATERIAL_OPAQUE) != 0u || meets_crystal(m.surface, sides)) return nothing_brought();
            ScatteringPoint s = scattering_point(p, direction, sides);
            shadow.contribution *= surface_transparency(s.surface, s.context, s.wo);
            polarize_passage(shadow, s);
            pass_straight(shadow, hit.primitive, hit.instance);
            if (is_black(shadow.contribution)) return nothing_brought();
        }
        vec3 origin = origin_behind(shadow.origin, p.position, p.error, p.geometric_normal, direction);
        if (t_left < INFINITY) {
            vec3 left = shadow.origin + t_left * direction - origin;
            t_left = dot(left, direction);
            if (!(t_left > 0.0)) return brought_by(shadow, analysed(shadow, weighed(shadow)));
            direction = normalize(left);
        }
        shadow.origin = origin;
        shadow.around = surroundings_towards(sides, p, shadow.direction);
        if (bends_rays(shadow.around.medium)) return nothing_brought();
    }
}

#else
#define origin_of_next(path, p, direction, straight) offset_origin(p.position, p.error, p.geometric_normal, direction)

Brought follow_shadow_ray(ShadowRay shadow) {
    locate_ray(shadow.location);
    if (find_occlusion(shadow.origin, shadow.direction, shadow.t_max)) return nothing_brought();
    pass_medium(shadow, shadow.t_max);
    return brought_by(shadow, analysed(shadow, weighed(shadow)));
}
#endif
