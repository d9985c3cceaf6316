// Receptors that are no planes: at every point of the plane stands a small sphere, hemisphere or cylinder, whose mean illuminance is
// measured; or planes with a window, a disk before them that all light must come through. For paths it is a point that scatters into all directions, by the part that it catches of the light from each. Shapes
// are the words of shaders/receivers/illuminance.glsl; each has a material of its own, from RECEPTOR_MATERIAL on.
//
// Light of radiance L brings to a sphere the integral of L / 4 over all directions, to a hemisphere about z that of L (1 + z) / 4, to
// the side of a cylinder along z that of L sqrt(1 - z²) / pi (the means over their surfaces): the densities below, times pi.
#include "features/spectrum.glsl"
#include "interfaces/receiver.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/warps.glsl"

#if HAS_RECEPTOR_SHAPES
bool is_shaped(uint material) { return material != NO_RECORD && material > RECEPTOR_MATERIAL && material <= RECEPTOR_MATERIAL + SHAPE_WINDOW; }

uint shape_of(uint material) { return material - RECEPTOR_MATERIAL; }

// Of a window, in the frame of the point: the middle of the disk over its distance in uv0, its radius over that in uv1.x.
void place_window(inout SurfacePoint p, vec4 pupil) {
    vec3 to = (pupil.xyz - p.position) * frame_around(p.geometric_normal);
    p.uv0 = to.xy / to.z, p.uv1 = vec2(pupil.w / to.z, 0.0);
}
bool is_in_window(SurfaceContext c, vec3 w) {
    return w.z > 0.0 && length(w.xy - c.uv0 * w.z) < c.uv1.x * w.z;
}

// 1/sr
float shape_density(uint shape, SurfaceContext c, vec3 w) {
    float z = w.z;
    // Points of the disk are drawn evenly.
    if (shape == SHAPE_WINDOW) return is_in_window(c, w) ? INV_PI / (square(c.uv1.x) * z * z * z) : 0.0;
    if (shape == SHAPE_HEMISPHERE) return (1.0 + z) * (0.25 * INV_PI);
    if (shape == SHAPE_CYLINDER) return sqrt(max(1.0 - z * z, 0.0)) * square(INV_PI);
    return 0.25 * INV_PI;
}

// Of the part that is caught, times pi: of a plane the cosine. 1/sr
float shape_value(uint shape, SurfaceContext c, vec3 w) {
    return shape != SHAPE_WINDOW ? shape_density(shape, c, w) : is_in_window(c, w) ? w.z * INV_PI : 0.0;
}

vec3 sample_shape(uint shape, SurfaceContext c, vec3 u) {
    if (shape == SHAPE_WINDOW) return normalize(vec3(c.uv0 + c.uv1.x * warp_disk(u.xy), 1.0));
    float z = 2.0 * u.x - 1.0;
    vec2 turn = cos_sin_turns(u.y);
    if (shape == SHAPE_HEMISPHERE) z = 2.0 * sqrt(u.x) - 1.0;
    if (shape == SHAPE_CYLINDER) {
        z = warp_disk(u.xy).x;
        turn = cos_sin_turns(u.z);
    }
    return vec3(sqrt(max(1.0 - z * z, 0.0)) * turn, z);
}

// As surface_pair: backward paths come along the normal and leave towards the light, forward ones the other way round. Light that
// crosses the plane at a flat angle stands for more of what there is.
Scattering shape_pair(uint shape, SurfaceContext c, vec3 wo, vec3 wi) {
    float to_wi = shape_density(shape, c, wi), to_wo = shape_density(shape, c, wo);
    float light_cosine = HAS_SHADING_NORMALS == 1 ? 1.0 : max(abs(wo.z), 1e-6);  // features/shading_normals.glsl
    float value = c.importance ? shape_value(shape, c, wo) * abs(wi.z) / light_cosine : shape_value(shape, c, wi);
    return scattering_of(SurfacePair(Spectrum(value), to_wi, to_wo));
}

SurfaceEvent shape_event(uint shape, SurfaceContext c, vec3 wo, vec3 wi, vec3 second, vec3 u) {
    SurfaceEvent event = no_surface_event();
    event.pair = shape_pair(shape, c, wo, wi);
    event.second = shape_pair(shape, c, wo, second);
    vec3 next = sample_shape(shape, c, u);
    event.next = scattered(next, next.z * wo.z > 0.0 ? EVENT_REFLECT : EVENT_TRANSMIT);
    complete(event, shape_pair(shape, c, wo, next));
    return event;
}
#else
#define is_shaped(material) false
#define place_window(p, pupil)
#define shape_of(material) 0u
#define shape_pair(shape, c, wo, wi) scattering_of(no_surface_pair())
#define shape_event(shape, c, wo, wi, second, u) no_surface_event()
#endif
