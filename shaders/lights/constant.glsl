// The same radiance from every direction, from infinitely far away.
//
// Example:
//     {"extensions": {"ETD_optics": {
//         "environment": {"class": "constant", "radiance": 0.8}}}}
struct ConstantEnvironment {
    SpectrumRef radiance;  //: 1 in [0, inf) cd/m². Radiance.
};

vec3 constant_direction(vec2 u) {
    float y = 1.0 - 2.0 * u.y;
    vec2 around = cos_sin_turns(u.x) * sqrt(max(0.0, 4.0 * u.y * (1.0 - u.y)));
    return vec3(around.x, y, around.y);
}

LightSample constant_sample_towards(ConstantEnvironment r, vec3 point, vec2 u) {
    return LightSample(constant_direction(u), INFINITY, untinted_value(r.radiance), 0.25 * INV_PI,
                       0.25 * INV_PI * outer_disk_pdf(scene_bounds()), false);
}

float constant_pdf_towards(ConstantEnvironment r, vec3 point, vec3 direction, LightHit hit) { return 0.25 * INV_PI; }

Spectrum constant_radiance(ConstantEnvironment r, vec3 direction, LightHit hit) { return untinted_value(r.radiance); }

EmittedRay constant_emit(ConstantEnvironment r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    vec3 direction = constant_direction(u_direction);
    return EmittedRay(outer_disk_point(bounds, direction, u_position), vec3(0), direction, direction,
                      untinted_value(r.radiance), 0.25 * INV_PI * outer_disk_pdf(bounds), false, true);
}

float constant_pdf_emit(ConstantEnvironment r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return 0.25 * INV_PI * outer_disk_pdf(bounds);
}

float constant_power(ConstantEnvironment r, SceneBounds bounds) {
    return 4.0 * square(PI * bounds.radius) * luminance(untinted_value(r.radiance));
}

void constant_bounds(ConstantEnvironment r, out vec3 lo, out vec3 hi) { lo = vec3(1), hi = vec3(-1); }

LightCone constant_cone(ConstantEnvironment r) { return whole_sphere_cone(); }
