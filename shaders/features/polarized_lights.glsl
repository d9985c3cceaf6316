// Lights that are polarized from the start, all of their light alike or ray by ray.
#include "features/defaults.glsl"
#include "features/light_selection.glsl"
#include "interfaces/light_source.glsl"
#include "lib/stokes.glsl"

#if HAS_POLARIZED_LIGHTS
layout(scalar, set = 0) readonly buffer LightStokesTable { LightStokes light_stokes[]; };  // in the order of `lights`

Polarization polarization_of(LightStokes l, vec3 direction) {
    vec3 axis = l.axis - direction * dot(l.axis, direction);
    float length_squared = dot(axis, axis);
    vec3 own = stokes_axis(direction);
    vec2 angle = length_squared > 1e-12 ? double_angle(axis * inversesqrt(length_squared), own, direction) : vec2(1, 0);
    return turned(Polarization(Spectrum(l.stokes.x), Spectrum(l.stokes.y), Spectrum(l.stokes.z)), angle);
}

// Of what the light sends along a direction.
Polarization light_polarization(uint light, vec3 direction) { return polarization_of(light_stokes[light], direction); }
#else
#define light_polarization(light, direction) unpolarized()
#endif

#if HAS_POLARIZED_RAYS
// Of a ray that it has emitted: what the scene says of the light goes before what the ray has.
Polarization ray_polarization(uint light, vec3 direction, vec2 u_position, vec2 u_direction) {
    LightStokes result = light_stokes[light];
    if (result.stokes != vec3(0)) return polarization_of(result, direction);
    uint ref = lights[light];
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_emitted_stokes(name##_record(record_index(ref)), u_position, u_direction); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return polarization_of(result, direction);
}
#else
#define ray_polarization(light, direction, u_position, u_direction) light_polarization(light, direction)
#endif
