// A camera of parallel rays as glTF defines it: looks along -z of its node, +y up. The image's height is 2 ymag; its
// width follows the image's aspect.
//
// Example:
//     {"nodes": [{"name": "camera", "translation": [2.4, 2.7, 3], "rotation": [-0.26, 0.255, 0.072, 0.929], "extensions": {"ETD_optics": {
//         "receiver": {"class": "orthographic", "ymag": 1.6}}}}]}
struct OrthographicCamera {
    Placement placement;
    float ymag;  //: 1 in (0, inf) m. Half the height of the view.
};

// Columns: what spans the film, and a step along the rays.
mat3 orthographic_frame(OrthographicCamera r, float film_aspect) {
    mat4x3 m = r.placement.world_from_local;
    return mat3(m[0] * (r.ymag * film_aspect), m[1] * r.ymag, -m[2]);
}

// Area of the whole film across the rays, m². A sheared node's rays do not stand upright on it.
float orthographic_area(mat3 f) { return 4.0 * abs(dot(cross(f[0], f[1]), normalize(f[2]))); }

CameraRay orthographic_emit(OrthographicCamera r, vec2 film, vec2 u, float film_aspect) {
    mat3 f = orthographic_frame(r, film_aspect);
    vec3 origin = r.placement.world_from_local[3] + f * vec3(2.0 * film.x - 1.0, 1.0 - 2.0 * film.y, 0.0);
    return CameraRay(origin, normalize(f[2]), 1.0, 1.0 / orthographic_area(f), 1.0, true, false, 0u);
}

ReceiverSample orthographic_connect(OrthographicCamera r, vec3 point, vec2 u, float film_aspect) {
    mat3 f = orthographic_frame(r, film_aspect);
    vec3 local = scaled_local(f, point - r.placement.world_from_local[3]) / abs(frame_volume(f));
    if (!(local.z > 0.0) || any(greaterThan(abs(local.xy), vec2(1)))) return no_receiver_sample();
    return ReceiverSample(-normalize(f[2]), local.z * length(f[2]), vec2(0.5 + 0.5 * local.x, 0.5 - 0.5 * local.y),
                          1.0 / orthographic_area(f), 1.0, 1.0);
}

float orthographic_footprint(OrthographicCamera r, vec3 point, float film_aspect, out float slope) {
    slope = 0.0;
    return sqrt(orthographic_area(orthographic_frame(r, film_aspect)));
}
