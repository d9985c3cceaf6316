// Receptors that are no planes: at every point of the plane stands a small sphere, hemisphere or cylinder, whose mean illuminance is
// measured. For paths it is a point that scatters into all directions, by the part that it catches of the light from each. Shapes
// are the words of shaders/receivers/illuminance.glsl; each has a material of its own, from RECEPTOR_MATERIAL on.
//
// Light of radiance L brings to a sphere the integral of L / 4 over all directions, to a hemisphere about z that of L (1 + z) / 4, to
// the side of a cylinder along z that of L sqrt(1 - z²) / pi (the means over their surfaces): the densities below, times pi.
#include "features/spectrum.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/warps.glsl"

const uint SHAPE_PLANE = 0u, SHAPE_HEMISPHERE = 1u, SHAPE_SPHERE = 2u, SHAPE_CYLINDER = 3u;

#if HAS_RECEPTOR_SHAPES
bool is_shaped(uint material) { return material != NO_RECORD && material > RECEPTOR_MATERIAL && material <= RECEPTOR_MATERIAL + SHAPE_CYLINDER; }

uint shape_of(uint material) { return material - RECEPTOR_MATERIAL; }

// 1/sr
float shape_density(uint shape, float z) {
    if (shape == SHAPE_HEMISPHERE) return (1.0 + z) * (0.25 * INV_PI);
    if (shape == SHAPE_CYLINDER) return sqrt(max(1.0 - z * z, 0.0)) * square(INV_PI);
    return 0.25 * INV_PI;
}

vec3 sample_shape(uint shape, vec3 u) {
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
    float to_wi = shape_density(shape, wi.z), to_wo = shape_density(shape, wo.z);
    float light_cosine = HAS_SHADING_NORMALS == 1 ? 1.0 : max(abs(wo.z), 1e-6);  // features/shading_normals.glsl
    float value = c.importance ? to_wo * abs(wi.z) / light_cosine : to_wi;
    return scattering_of(SurfacePair(Spectrum(value), to_wi, to_wo));
}

SurfaceEvent shape_event(uint shape, SurfaceContext c, vec3 wo, vec3 wi, vec3 second, vec3 u) {
    SurfaceEvent event = no_surface_event();
    event.pair = shape_pair(shape, c, wo, wi);
    event.second = shape_pair(shape, c, wo, second);
    vec3 next = sample_shape(shape, u);
    event.next = scattered(next, next.z * wo.z > 0.0 ? EVENT_REFLECT : EVENT_TRANSMIT);
    complete(event, shape_pair(shape, c, wo, next));
    return event;
}
#else
#define is_shaped(material) false
#define shape_of(material) 0u
#define shape_pair(shape, c, wo, wi) scattering_of(no_surface_pair())
#define shape_event(shape, c, wo, wi, second, u) no_surface_event()
#endif
