// A pinhole camera as glTF defines it: looks along -z of its node, +y up.
struct PerspectiveCamera {
    Placement placement;
    float yfov;  //: 0.7853981634 in (0, 3.1415926) rad. Vertical field of view.
};

CameraRay perspective_emit(PerspectiveCamera r, vec2 film, float film_aspect) {
    float h = tan(0.5 * r.yfov);
    vec3 d = vec3((2.0 * film.x - 1.0) * h * film_aspect, (1.0 - 2.0 * film.y) * h, -1.0);
    mat4x3 m = r.placement.world_from_local;
    return CameraRay(m[3], normalize(mat3(m[0], m[1], m[2]) * d), 1.0);
}
