// A point that sends light into a cone around -z of its node (glTF KHR_lights_punctual). Between the inner
// and the outer angle the intensity falls off as that specification recommends: the square of ((cos - cos
// outer) / (cos inner - cos outer)). Of the node's transform only position and direction count: scale does
// not change the intensity.
struct SpotLight {
    Placement placement;
    SpectrumRef color;       //: 1 in [0, inf). Multiplies the intensity.
    float intensity;         //: 1 in [0, inf) cd. Luminous intensity within the inner cone.
    float inner_cone_angle;  //: 0 in [0, 1.5707964] rad. From the axis to where the falloff starts; at most the outer angle.
    float outer_cone_angle;  //: 0.7853981634 in (0, 1.5707964] rad. From the axis to where the falloff ends.
    float range;             //: 0 in [0, inf) m. Read and not used: light falls off with the square of the distance alone.
};

vec3 spot_axis(SpotLight r) { return -normalize(r.placement.world_from_local[2]); }

// Part of the full intensity along a unit direction away from the light.
float spot_falloff(SpotLight r, vec3 direction) {
    vec3 axis = spot_axis(r);
    float c = dot(axis, direction);
    vec3 off = cross(axis, direction);
    float v = c > 0.0 ? dot(off, off) / (1.0 + c) : 1.0 - c;
    float outer = versine(r.outer_cone_angle);
    float inner = min(versine(r.inner_cone_angle), outer);
    float width = outer - inner;
    float t = width > 1e-6 * outer ? clamp((outer - v) / width, 0.0, 1.0) : (v < outer ? 1.0 : 0.0);
    return t * t;
}

LightSample spot_sample_towards(SpotLight r, vec3 point, vec2 u) {
    vec3 d = r.placement.world_from_local[3] - point;
    float distance = length(d);
    if (!(distance > 0.0)) return no_light_sample();
    vec3 direction = d / distance;
    float falloff = spot_falloff(r, -direction);
    if (!(falloff > 0.0)) return no_light_sample();
    Spectrum irradiance = spectrum_value(r.color) * (r.intensity * falloff / distance / distance);
    return LightSample(direction, distance, irradiance, 1.0, true);
}

float spot_pdf_towards(SpotLight r, vec3 point, vec3 direction, LightHit hit) { return 0.0; }
Spectrum spot_radiance(SpotLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

// The integral of the falloff over directions: 2 pi (v_inner + (v_outer - v_inner) / 3), v = 1 - cos.
float spot_power(SpotLight r, SceneBounds bounds) {
    float outer = versine(r.outer_cone_angle);
    float inner = min(versine(r.inner_cone_angle), outer);
    return 2.0 * PI * (inner + (outer - inner) / 3.0) * r.intensity * luminance(spectrum_value(r.color));
}

void spot_bounds(SpotLight r, out vec3 lo, out vec3 hi) { lo = hi = r.placement.world_from_local[3]; }

LightCone spot_cone(SpotLight r) {
    float inner = min(r.inner_cone_angle, r.outer_cone_angle);
    return LightCone(spot_axis(r), cos(inner), cos(r.outer_cone_angle - inner));
}
