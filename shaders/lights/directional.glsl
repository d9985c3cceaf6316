// Parallel light along -z of its node, from infinitely far away (glTF KHR_lights_punctual).
//
// Example:
//     {"nodes": [{"name": "sun", "rotation": [-0.37, -0.22, -0.09, 0.9], "extensions": {"ETD_optics": {
//         "light": {"class": "directional", "color": [1, 0.93, 0.8], "intensity": 4}}}}]}
struct DirectionalLight {
    Placement placement;
    SpectrumRef color;  //: 1 in [0, inf). Multiplies the intensity.
    float intensity;    //: 1 in [0, inf) lx. Illuminance of a plane that faces the light.
};

LightSample directional_sample_towards(DirectionalLight r, vec3 point, vec2 u) {
    vec3 direction = normalize(r.placement.world_from_local[2]);
    return LightSample(direction, INFINITY, untinted_value(r.color) * r.intensity, 1.0, outer_disk_pdf(scene_bounds()), true);
}

float directional_pdf_towards(DirectionalLight r, vec3 point, vec3 direction, LightHit hit) { return 1.0; }
Spectrum directional_radiance(DirectionalLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

EmittedRay directional_emit(DirectionalLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    vec3 direction = -normalize(r.placement.world_from_local[2]);
    return EmittedRay(outer_disk_point(bounds, direction, u_position), vec3(0), direction, direction,
                      untinted_value(r.color) * r.intensity, outer_disk_pdf(bounds), true, true);
}

float directional_pdf_emit(DirectionalLight r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return outer_disk_pdf(bounds);
}

float directional_power(DirectionalLight r, SceneBounds bounds) {
    return PI * square(bounds.radius) * r.intensity * luminance(untinted_value(r.color));
}

void directional_bounds(DirectionalLight r, out vec3 lo, out vec3 hi) { lo = vec3(1), hi = vec3(-1); }

LightCone directional_cone(DirectionalLight r) { return whole_sphere_cone(); }
