// A panorama: all directions around the origin of its node; the image's centre is -z, columns are longitude, to the right, and rows
// latitude, +y at the top (equirectangular).
//
// Example:
//     {"nodes": [{"name": "panorama", "translation": [0.2, 1.1, 0], "extensions": {"ETD_optics": {
//         "receiver": {"class": "panorama"}}}}]}
struct PanoramaCamera {
    Placement placement;
};

mat3 panorama_frame(PanoramaCamera r) {
    mat4x3 m = r.placement.world_from_local;
    vec3 up = normalize(m[1]), back = normalize(m[2] - dot(m[2], up) * up);
    vec3 right = cross(up, back);
    return mat3(dot(right, m[0]) < 0.0 ? -right : right, up, back);
}

// 1/sr; rows shrink to points at the poles.
float panorama_density(float cos_latitude) { return 1.0 / (2.0 * square(PI) * max(cos_latitude, 1e-6)); }

CameraRay panorama_emit(PanoramaCamera r, vec2 film, vec2 u, float film_aspect) {
    vec2 around = cos_sin_turns(film.x - 0.5), rise = cos_sin_turns(0.25 - 0.5 * film.y);
    vec3 local = vec3(rise.x * around.y, rise.y, -rise.x * around.x);
    return CameraRay(r.placement.world_from_local[3], panorama_frame(r) * local, 1.0, panorama_density(rise.x), 1.0, false, false, 0u);
}

ReceiverSample panorama_connect(PanoramaCamera r, vec3 point, vec2 u, float film_aspect) {
    vec3 d = point - r.placement.world_from_local[3];
    float distance = length(d);
    vec3 local = d * panorama_frame(r) / distance;
    float level = length(local.xz);
    vec2 film = vec2(0.5 + accurate_atan2(local.x, -local.z) * (0.5 * INV_PI), 0.5 - accurate_atan2(local.y, level) * INV_PI);
    return ReceiverSample(-d / distance, distance, film, panorama_density(level), 1.0, distance * distance);
}

float panorama_footprint(PanoramaCamera r, vec3 point, float film_aspect, out float slope) {
    slope = sqrt(4.0 * PI);
    return max(length(point - r.placement.world_from_local[3]), 1e-12) * slope;
}
