// Lights that are polarized from the start.
#include "features/defaults.glsl"
#include "lib/stokes.glsl"

#if HAS_POLARIZED_LIGHTS
// Twin in host/scene/records.h.
struct LightStokes {
    vec3 stokes;  // S1 to S3 over S0
    vec3 axis;    // x of their frame, as far as it lies across the light's direction; unit, in world space
};
layout(scalar, set = 0) readonly buffer LightStokesTable { LightStokes light_stokes[]; };  // in the order of `lights`

// Of what the light sends along a direction.
Polarization light_polarization(uint light, vec3 direction) {
    LightStokes l = light_stokes[light];
    vec3 axis = l.axis - direction * dot(l.axis, direction);
    float length_squared = dot(axis, axis);
    vec3 own = stokes_axis(direction);
    vec2 angle = length_squared > 1e-12 ? double_angle(axis * inversesqrt(length_squared), own, direction) : vec2(1, 0);
    return turned(Polarization(Spectrum(l.stokes.x), Spectrum(l.stokes.y), Spectrum(l.stokes.z)), angle);
}
#else
#define light_polarization(light, direction) unpolarized()
#endif
