// An illuminance meter: a rectangle in the xy plane around the origin of its node that faces +z and measures at every point what falls
// on it from there, whatever lies behind; a floor or a desk may coincide with it. Other shapes measure at its points the mean
// illuminance of a small body: a sphere, a hemisphere that bulges towards +z, or the side of a cylinder along z (cylindrical
// illuminance where z stands upright); these see both sides, and nothing should coincide with their plane. Light passes on as if the
// meter were not there. Seen from +z, x runs to the right and y up. A pixel: lx.
//
// Example:
//     {"nodes": [{"name": "desk", "translation": [0, 0.8, 0], "rotation": [-0.7071, 0, 0, 0.7071], "extensions": {"ETD_optics": {
//         "receiver": {"class": "illuminance", "size": [1.6, 0.8], "resolution": [32, 16]}}}}]}
struct IlluminanceMeter {
    Placement placement;
    vec2 size;        //: required in (0, inf) m. Width along x and height along y.
    vec2 resolution;  //: [64, 64] in [1, 16384]. Pixels along x and y.
    uint shape;       //: "plane" of plane|hemisphere|sphere|cylinder. What is lit at each point.
    vec2 pupil;       //: [0, 0] in [0, inf) m. Of a plane: distance along +z and radius of a disk about z; only light that comes through it is measured, which is where paths go. 0: all light.
};

// With the film of a camera: what its lens sends.
uint illuminance_shape(IlluminanceMeter r) { return r.pupil.y > 0.0 ? SHAPE_WINDOW : r.shape; }

vec3 illuminance_normal(mat4x3 m, out float area) {
    vec3 n = cross(m[0], m[1]);
    area = length(n);
    return (dot(n, m[2]) < 0.0 ? -n : n) / area;
}

// The paths start at their points, along the normal, and meet the receptor there: E is pi times what a white diffuse surface sends.
CameraRay illuminance_emit(IlluminanceMeter r, vec2 film, vec2 u, float film_aspect) {
    mat4x3 m = r.placement.world_from_local;
    float area;
    vec3 normal = illuminance_normal(m, area);
    vec3 origin = m * vec4((film.x - 0.5) * r.size.x, (0.5 - film.y) * r.size.y, 0.0, 1.0);
    return CameraRay(origin, -normal, PI, 1.0 / (area * r.size.x * r.size.y), 1.0, true, true, illuminance_shape(r));
}

// Where a point is, in sizes from the middle.
vec3 illuminance_place(IlluminanceMeter r, vec3 normal, vec3 point) {
    mat4x3 m = r.placement.world_from_local;
    mat3 f = mat3(m[0] * r.size.x, m[1] * r.size.y, normal);
    return scaled_local(f, point - m[3]) / abs(frame_volume(f));
}

// Of a point on the receptor.
ReceiverSample illuminance_connect(IlluminanceMeter r, vec3 point, vec2 u, float film_aspect) {
    float area;
    vec3 normal = illuminance_normal(r.placement.world_from_local, area);
    vec3 place = illuminance_place(r, normal, point);
    vec2 film = clamp(vec2(0.5 + place.x, 0.5 - place.y), 0.0, 1.0);
    return ReceiverSample(normal, 0.0, film, 1.0 / (area * r.size.x * r.size.y), PI, 1.0);
}

ReceptorHit illuminance_receptor(IlluminanceMeter r, vec3 origin, vec3 direction) {
    mat4x3 m = r.placement.world_from_local;
    float area;
    vec3 normal = illuminance_normal(m, area);
    float facing = -dot(direction, normal), height = dot(origin - m[3], normal);
    if (r.shape == 0u && !(facing > 0.0)) return no_receptor_hit();
    float t = height / facing;
    if (!(t > 0.0) || isinf(t)) return no_receptor_hit();
    vec3 place = illuminance_place(r, normal, origin + t * direction);
    if (any(greaterThan(abs(place.xy), vec2(0.5)))) return no_receptor_hit();
    return ReceptorHit(t, normal, illuminance_shape(r));
}

vec4 illuminance_pupil(IlluminanceMeter r) {
    mat4x3 m = r.placement.world_from_local;
    return vec4(m * vec4(0, 0, r.pupil.x, 1), r.pupil.y * length(m[0]));
}

float illuminance_footprint(IlluminanceMeter r, vec3 point, float film_aspect, out float slope) {
    float area;
    illuminance_normal(r.placement.world_from_local, area);
    slope = 0.0;
    return sqrt(area * r.size.x * r.size.y);
}
