// A point that sends light into a cone around -z of its node (glTF KHR_lights_punctual). Between the inner
// and the outer angle the intensity falls off as that specification recommends: the square of ((cos - cos
// outer) / (cos inner - cos outer)). Of the node's transform only position and direction count: scale does
// not change the intensity.
//
// Example:
//     {"nodes": [{"name": "spotlight", "translation": [0, 2, 2.2], "rotation": [-0.3, 0, 0, 0.954], "extensions": {"ETD_optics": {
//         "light": {"class": "spot", "intensity": 16, "inner_cone_angle": 0.25, "outer_cone_angle": 0.35}}}}]}
struct SpotLight {
    Placement placement;
    SpectrumRef color;       //: 1 in [0, inf). Multiplies the intensity.
    float intensity;         //: 1 in [0, inf) cd. Luminous intensity within the inner cone.
    float inner_cone_angle;  //: 0 in [0, 1.5707964] rad. From the axis to where the falloff starts; at most the outer angle.
    float outer_cone_angle;  //: 0.7853981634 in (0, 1.5707964] rad. From the axis to where the falloff ends.
    float range;             //: 0 in [0, inf) m. Read and not used: light falls off with the square of the distance alone.
};

vec3 spot_axis(SpotLight r) { return -normalize(r.placement.world_from_local[2]); }

// 1 - cos of the angles between which it falls off; equal where there is no falloff.
struct SpotFalloff { float inner, outer; };

SpotFalloff spot_cone_edges(SpotLight r) {
    float outer = versine(r.outer_cone_angle);
    float inner = versine(r.inner_cone_angle);
    return SpotFalloff(outer - inner > 1e-6 * outer ? inner : outer, outer);
}

// Part of the full intensity along a unit direction away from the light.
float spot_falloff(SpotLight r, vec3 direction) {
    vec3 axis = spot_axis(r);
    float c = dot(axis, direction);
    vec3 off = cross(axis, direction);
    float v = c > 0.0 ? dot(off, off) / (1.0 + c) : 1.0 - c;
    SpotFalloff f = spot_cone_edges(r);
    float t = f.outer > f.inner ? clamp((f.outer - v) / (f.outer - f.inner), 0.0, 1.0) : (v < f.outer ? 1.0 : 0.0);
    return t * t;
}

// The integral of the falloff over directions, sr: 2 pi (v_inner + (v_outer - v_inner) / 3), v = 1 - cos.
float spot_solid_angle(SpotFalloff f) { return 2.0 * PI * (f.inner + (f.outer - f.inner) / 3.0); }

LightSample spot_sample_towards(SpotLight r, vec3 point, vec2 u) {
    vec3 d = r.placement.world_from_local[3] - point;
    float distance = length(d);
    if (!(distance > 0.0)) return no_light_sample();
    vec3 direction = d / distance;
    float falloff = spot_falloff(r, -direction);
    if (!(falloff > 0.0)) return no_light_sample();
    return LightSample(direction, distance, untinted_value(r.color) * (r.intensity * falloff), square(distance),
                       falloff / spot_solid_angle(spot_cone_edges(r)), true);
}

float spot_pdf_towards(SpotLight r, vec3 point, vec3 direction, LightHit hit) {
    vec3 d = hit.position - point;
    return dot(d, d);
}

Spectrum spot_radiance(SpotLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

// In proportion to the falloff: inverts its integral over v, first the even part within the inner cone, then what is left
// of the cubic beyond it, 1 - t³ with t = (v_outer - v) / (v_outer - v_inner).
EmittedRay spot_emit(SpotLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    SpotFalloff f = spot_cone_edges(r);
    float tail = (f.outer - f.inner) / 3.0;
    float v = u_direction.x * (f.inner + tail);
    float t = 1.0;
    if (v > f.inner) {
        float cube = max(1.0 - (v - f.inner) / tail, EPSILON);
        t = pow(cube, 1.0 / 3.0);
        t = (2.0 * t + cube / square(t)) / 3.0;  // Newton: a driver's pow may be coarse
        v = f.outer - t * (f.outer - f.inner);
    }
    vec2 around = cos_sin_turns(u_direction.y) * sqrt(v * (2.0 - v));
    vec3 direction = normalize(frame_around(spot_axis(r)) * vec3(around, 1.0 - v));
    float falloff = square(t);
    return EmittedRay(r.placement.world_from_local[3], vec3(0), direction, direction,
                      untinted_value(r.color) * (r.intensity * falloff), falloff / spot_solid_angle(f), true, true);
}

float spot_pdf_emit(SpotLight r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return spot_falloff(r, -direction) / spot_solid_angle(spot_cone_edges(r));
}

float spot_power(SpotLight r, SceneBounds bounds) {
    return spot_solid_angle(spot_cone_edges(r)) * r.intensity * luminance(untinted_value(r.color));
}

void spot_bounds(SpotLight r, out vec3 lo, out vec3 hi) { lo = hi = r.placement.world_from_local[3]; }

LightCone spot_cone(SpotLight r) {
    float inner = min(r.inner_cone_angle, r.outer_cone_angle);
    return LightCone(spot_axis(r), cos(inner), cos(r.outer_cone_angle - inner));
}
