// A beam: a disk that sends light along -z of its node, evenly over its area. Each point of it sends evenly into a cone of directions,
// or into one direction alone. Of the node's transform only position and directions count. The disk is no surface: it lights what it
// shines on, but is not seen itself, nor in mirrors.
//
// Within the beam a plane across it has the illuminance power / (pi radius²), near and far, as long as the cone towards every point
// lies within the disk. Of a beam without divergence forward rays alone bring the light: no other ray goes its way.
//
// Example:
//     {"nodes": [{"name": "laser", "translation": [-0.9, 1.5, 0.9], "rotation": [-0.42, -0.33, -0.17, 0.83], "extensions": {"ETD_optics": {
//         "light": {"class": "collimated", "radius": 0.22, "divergence": 0.06, "power": 0.6, "color": [1, 0.3, 0.1]}}}}]}
struct CollimatedLight {
    Placement placement;
    SpectrumRef color;  //: 1 in [0, inf). Multiplies the power. A spectrum is in W/nm, and the power is how many times that.
    float radius;       //: 0.001 in (0, inf) m. Of the disk.
    float divergence;   //: 0 in [0, 1.5] rad. Half the angle of the cone; less than a microradian counts as none.
    float power;        //: 1 in [0, inf) lm. Luminous flux.
};

vec3 collimated_axis(CollimatedLight r) { return -normalize(r.placement.world_from_local[2]); }
float collimated_area(CollimatedLight r) { return PI * square(r.radius); }
bool collimated_is_parallel(CollimatedLight r) { return r.divergence < 1e-6; }
float collimated_solid_angle(CollimatedLight r) { return 2.0 * PI * versine(r.divergence); }

// Radius of the part of the disk that lights a point in this distance from its plane, around where the point stands before it.
float collimated_reach(CollimatedLight r, float height) {
    vec2 t = cos_sin_turns(r.divergence * (0.5 * INV_PI));
    return height * t.y / t.x;
}

// Points are drawn on the smaller of two disks, the light's and that of collimated_reach: what lies outside the other is dark. 1/sr.
float collimated_pdf_towards(CollimatedLight r, vec3 point, vec3 direction, LightHit hit) {
    vec3 axis = collimated_axis(r);
    float height = dot(axis, point - r.placement.world_from_local[3]), cosine = -dot(axis, direction);
    if (collimated_is_parallel(r) || !(height > 0.0) || !(cosine > 0.0)) return 0.0;
    return square(height) / (cosine * square(cosine) * PI * square(min(r.radius, collimated_reach(r, height))));
}

LightSample collimated_sample_towards(CollimatedLight r, vec3 point, vec2 u) {
    vec3 axis = collimated_axis(r), d = point - r.placement.world_from_local[3];
    float height = dot(axis, d);
    if (collimated_is_parallel(r) || !(height > 0.0)) return no_light_sample();
    float reach = collimated_reach(r, height);
    mat3 frame = frame_around(axis);
    vec2 before = (d * frame).xy, drawn = warp_disk(u) * min(r.radius, reach);
    vec2 to = reach < r.radius ? drawn : drawn - before;  // from where the point stands before the plane
    if (dot(to, to) > square(reach) || dot(to + before, to + before) > square(r.radius)) return no_light_sample();
    vec3 way = frame * vec3(to, -height);
    float distance = length(way);
    vec3 direction = way / distance;
    float density = 1.0 / (collimated_area(r) * collimated_solid_angle(r) * (height / distance));
    return LightSample(direction, distance, untinted_value(r.color) * (r.power * density),
                       collimated_pdf_towards(r, point, direction, LightHit(vec3(0), vec3(0), vec2(0), vec2(0))), density, true);
}

Spectrum collimated_radiance(CollimatedLight r, vec3 direction, LightHit hit) { return Spectrum(0); }

float collimated_pdf_emit(CollimatedLight r, SceneBounds bounds, vec3 direction, LightHit hit) {
    float over_area = 1.0 / collimated_area(r);
    return collimated_is_parallel(r) ? over_area : over_area / (collimated_solid_angle(r) * -dot(collimated_axis(r), direction));
}

EmittedRay collimated_emit(CollimatedLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    mat3 frame = frame_around(collimated_axis(r));
    vec3 origin = r.placement.world_from_local[3] + frame * vec3(r.radius * warp_disk(u_position), 0.0);
    float v = collimated_is_parallel(r) ? 0.0 : u_direction.x * versine(r.divergence);  // 1 - cosine
    vec3 direction = normalize(frame * vec3(cos_sin_turns(u_direction.y) * sqrt(v * (2.0 - v)), 1.0 - v));
    float density = collimated_pdf_emit(r, bounds, -direction, LightHit(vec3(0), vec3(0), vec2(0), vec2(0)));
    return EmittedRay(origin, vec3(0), direction, direction, untinted_value(r.color) * (r.power * density), density, true, true);
}

float collimated_power(CollimatedLight r, SceneBounds bounds) { return r.power * luminance(untinted_value(r.color)); }

void collimated_bounds(CollimatedLight r, out vec3 lo, out vec3 hi) {
    vec3 axis = collimated_axis(r);
    vec3 extent = r.radius * sqrt(max(1.0 - axis * axis, 0.0));
    lo = r.placement.world_from_local[3] - extent;
    hi = r.placement.world_from_local[3] + extent;
}

LightCone collimated_cone(CollimatedLight r) {
    if (collimated_is_parallel(r)) return unmet_rays();
    return LightCone(collimated_axis(r), 1.0, cos(r.divergence));
}
