// Parallel light along -z of its node, from infinitely far away (glTF KHR_lights_punctual).
struct DirectionalLight {
    Placement placement;
    SpectrumRef color;  //: 1 in [0, inf). Multiplies the intensity.
    float intensity;    //: 1 in [0, inf) lx. Illuminance of a plane that faces the light.
};

LightSample directional_sample_towards(DirectionalLight r, vec3 point, vec2 u) {
    vec3 direction = normalize(r.placement.world_from_local[2]);
    return LightSample(direction, INFINITY, spectrum_value(r.color) * r.intensity, 1.0, true);
}

float directional_pdf_towards(DirectionalLight r, vec3 point, vec3 direction, LightHit hit) { return 0.0; }
Spectrum directional_radiance(DirectionalLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

float directional_power(DirectionalLight r, SceneBounds bounds) {
    return PI * square(bounds.radius) * r.intensity * luminance(spectrum_value(r.color));
}

void directional_bounds(DirectionalLight r, out vec3 lo, out vec3 hi) { lo = vec3(1), hi = vec3(-1); }

LightCone directional_cone(DirectionalLight r) { return whole_sphere_cone(); }
