// A camera of parallel rays as glTF defines it: looks along -z of its node, +y up. The image's height is 2 ymag; its
// width follows the image's aspect.
struct OrthographicCamera {
    Placement placement;
    float ymag;  //: 1 in (0, inf) m. Half the height of the view.
};

CameraRay orthographic_emit(OrthographicCamera r, vec2 film, float film_aspect) {
    mat4x3 m = r.placement.world_from_local;
    vec3 o = vec3((2.0 * film.x - 1.0) * r.ymag * film_aspect, (1.0 - 2.0 * film.y) * r.ymag, 0.0);
    return CameraRay(m * vec4(o, 1.0), normalize(-m[2]), 1.0);
}
