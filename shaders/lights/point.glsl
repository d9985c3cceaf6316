// A point that sends the same luminous intensity in every direction (glTF KHR_lights_punctual).
// Of the node's transform only the position counts: scale does not change the intensity.
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
    Spectrum irradiance = spectrum_value(r.color) * (r.intensity / distance / distance);
    return LightSample(d / distance, distance, irradiance, 1.0, true);
}

float point_pdf_towards(PointLight r, vec3 point, vec3 direction, LightHit hit) { return 0.0; }
Spectrum point_radiance(PointLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

float point_power(PointLight r, SceneBounds bounds) { return 4.0 * PI * r.intensity * luminance(spectrum_value(r.color)); }

void point_bounds(PointLight r, out vec3 lo, out vec3 hi) { lo = hi = r.placement.world_from_local[3]; }

LightCone point_cone(PointLight r) { return whole_sphere_cone(); }
