// A point that sends the same luminous intensity in every direction (glTF KHR_lights_punctual).
// Of the node's transform only the position counts: scale does not change the intensity.
//
// Example:
//     {"nodes": [{"name": "bulb", "translation": [-0.5, 1.3, 0.4], "extensions": {"ETD_optics": {
//         "light": {"class": "point", "intensity": 4}}}}]}
struct PointLight {
    Placement placement;
    SpectrumRef color;  //: 1 in [0, inf). Multiplies the intensity.
    float intensity;    //: 1 in [0, inf) cd. Luminous intensity.
    float range;        //: 0 in [0, inf) m. Read and not used: light falls off with the square of the distance alone.
};

LightSample point_sample_towards(PointLight r, vec3 point, vec2 u) {
    vec3 d = r.placement.world_from_local[3] - point;
    float distance = length(d);
    if (!(distance > 0.0)) return no_light_sample();
    return LightSample(d / distance, distance, untinted_value(r.color) * r.intensity, square(distance), 0.25 * INV_PI, true);
}

float point_pdf_towards(PointLight r, vec3 point, vec3 direction, LightHit hit) {
    vec3 d = hit.position - point;
    return dot(d, d);
}

Spectrum point_radiance(PointLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

EmittedRay point_emit(PointLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    float z = 1.0 - 2.0 * u_direction.x;
    vec2 around = cos_sin_turns(u_direction.y) * sqrt(4.0 * u_direction.x * (1.0 - u_direction.x));
    vec3 direction = vec3(around, z);
    return EmittedRay(r.placement.world_from_local[3], vec3(0), direction, direction, untinted_value(r.color) * r.intensity,
                      0.25 * INV_PI, true, true);
}

float point_pdf_emit(PointLight r, SceneBounds bounds, vec3 direction, LightHit hit) { return 0.25 * INV_PI; }

float point_power(PointLight r, SceneBounds bounds) { return 4.0 * PI * r.intensity * luminance(untinted_value(r.color)); }

void point_bounds(PointLight r, out vec3 lo, out vec3 hi) { lo = hi = r.placement.world_from_local[3]; }

LightCone point_cone(PointLight r) { return whole_sphere_cone(); }
