// A pinhole camera as glTF defines it: looks along -z of its node, +y up.
//
// Example:
//     {"nodes": [{"name": "camera", "translation": [0.2, 1.1, 4], "extensions": {"ETD_optics": {
//         "receiver": {"class": "perspective", "yfov": 0.8}}}}]}
struct PerspectiveCamera {
    Placement placement;
    float yfov;  //: 0.7853981634 in (0, 3.1415926) rad. Vertical field of view.
};

// Columns: what spans the film, one unit in front of the pinhole, and the way to its centre; a point of the film lies along
// (2 x - 1, 1 - 2 y, 1).
mat3 perspective_frame(PerspectiveCamera r, float film_aspect) {
    mat4x3 m = r.placement.world_from_local;
    vec2 p = cos_sin_small(0.25 * r.yfov);  // no driver's tangent: it may be off by 2^-11
    float h = 2.0 * p.x * p.y / ((p.x - p.y) * (p.x + p.y));
    return mat3(m[0] * (h * film_aspect), m[1] * h, -m[2]);
}

// 1/sr. Film points s, t map to w = f (s, t, 1), whose solid angle is |det f| / |w|³ ds dt; s and t run over 4 units.
float perspective_density(mat3 f, vec3 w) {
    float size = length(w);
    float volume = 4.0 * abs(frame_volume(f / size));
    return volume > 0.0 ? 1.0 / volume : 0.0;
}

CameraRay perspective_emit(PerspectiveCamera r, vec2 film, vec2 u, float film_aspect) {
    mat3 f = perspective_frame(r, film_aspect);
    vec3 w = f * vec3(2.0 * film.x - 1.0, 1.0 - 2.0 * film.y, 1.0);
    return CameraRay(r.placement.world_from_local[3], normalize(w), 1.0, perspective_density(f, w), 1.0, false,
                     false, 0u);
}

ReceiverSample perspective_connect(PerspectiveCamera r, vec3 point, vec2 u, float film_aspect) {
    mat3 f = perspective_frame(r, film_aspect);
    vec3 d = point - r.placement.world_from_local[3];
    vec3 local = scaled_local(f / length(f[2]), d);
    if (!(local.z > 0.0)) return no_receiver_sample();  // behind
    vec2 at = local.xy / local.z;
    if (any(greaterThan(abs(at), vec2(1)))) return no_receiver_sample();
    float distance = length(d);
    return ReceiverSample(-d / distance, distance, vec2(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y),
                          perspective_density(f, f * vec3(at, 1.0)), 1.0, distance * distance);
}

// The solid angle of the whole film as if it were small, at the distance of the point but for one that no scene resolves.
float perspective_footprint(PerspectiveCamera r, vec3 point, float film_aspect, out float slope) {
    mat3 f = perspective_frame(r, film_aspect);
    slope = inversesqrt(perspective_density(f, f[2]));
    return max(length(point - r.placement.world_from_local[3]), 1e-12) * slope;
}
