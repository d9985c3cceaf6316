// A camera with a thin lens: looks along -z of its node, +y up; what lies at the distance `focus` is sharp. A pixel is the mean
// radiance of the rays through all of the lens (Cook, Porter & Carpenter 1984).
//
// Example:
//     {"nodes": [{"name": "camera", "translation": [0.2, 1.1, 4], "extensions": {"ETD_optics": {
//         "receiver": {"class": "thin_lens", "yfov": 0.8, "focus": 4, "aperture": 0.15}}}}]}
struct ThinLensCamera {
    Placement placement;
    float yfov;      //: 0.7853981634 in (0, 3.1415926) rad. Vertical field of view.
    float focus;     //: required in (0, inf) m. Distance of the plane that is sharp.
    float aperture;  //: 0.005 in (0, inf) m. Radius of the lens.
};
#define thin_lens_HAS_APERTURE

// Columns: what spans the film on the plane in focus, and the way to its centre.
mat3 thin_lens_frame(ThinLensCamera r, float film_aspect) {
    mat4x3 m = r.placement.world_from_local;
    vec2 p = cos_sin_small(0.25 * r.yfov);
    float h = r.focus * 2.0 * p.x * p.y / ((p.x - p.y) * (p.x + p.y));
    return mat3(m[0] * (h * film_aspect), m[1] * h, -m[2] * r.focus);
}

// A disk, as large as the node's scale along x makes it, in the plane of the node's x and y.
struct Lens {
    vec3 point;   // drawn by u
    vec3 normal;
    float area;   // m²
};

Lens thin_lens_point(ThinLensCamera r, vec2 u) {
    mat4x3 m = r.placement.world_from_local;
    float radius = r.aperture * length(m[0]);
    vec3 x = normalize(m[0]), normal = normalize(cross(m[0], m[1]));
    vec2 disk = warp_disk(u) * radius;
    return Lens(m[3] + disk.x * x + disk.y * cross(normal, x), normal, PI * square(radius));
}

// 1/(m² sr). `w`: from the lens to the point in focus, which the frame's film spans.
float thin_lens_density(mat3 f, vec3 w, Lens lens) {
    float size = length(w);
    float solid_angle = 4.0 * abs(dot(cross(f[0], f[1]), w / size)) / square(size);
    float caught = lens.area * abs(dot(w, lens.normal)) / size;
    return solid_angle > 0.0 && caught > 0.0 ? 1.0 / (solid_angle * caught) : 0.0;
}

CameraRay thin_lens_emit(ThinLensCamera r, vec2 film, vec2 u, float film_aspect) {
    mat3 f = thin_lens_frame(r, film_aspect);
    Lens lens = thin_lens_point(r, u);
    vec3 w = r.placement.world_from_local[3] - lens.point + f * vec3(2.0 * film.x - 1.0, 1.0 - 2.0 * film.y, 1.0);
    vec3 direction = normalize(w);
    return CameraRay(lens.point, direction, 1.0, thin_lens_density(f, w, lens),
                     1.0 / (lens.area * abs(dot(direction, lens.normal))), false, false, 0u);
}

ReceiverSample thin_lens_connect(ThinLensCamera r, vec3 point, vec2 u, float film_aspect) {
    mat3 f = thin_lens_frame(r, film_aspect);
    Lens lens = thin_lens_point(r, u);
    vec3 d = point - lens.point, across = cross(f[0], f[1]);
    float ahead = dot(d, across), to_focus = dot(f[2], across);
    if (!(ahead * to_focus > 0.0)) return no_receiver_sample();  // behind
    vec3 w = d * (to_focus / ahead);
    vec3 local = scaled_local(f, lens.point - r.placement.world_from_local[3] + w) / abs(frame_volume(f));
    if (any(greaterThan(abs(local.xy), vec2(1)))) return no_receiver_sample();
    float distance = length(d);
    vec3 direction = d / distance;
    return ReceiverSample(-direction, distance, vec2(0.5 + 0.5 * local.x, 0.5 - 0.5 * local.y), thin_lens_density(f, w, lens), 1.0,
                          distance * distance / (lens.area * abs(dot(direction, lens.normal))));
}

// As of a pinhole at its centre.
float thin_lens_footprint(ThinLensCamera r, vec3 point, float film_aspect, out float slope) {
    mat3 f = thin_lens_frame(r, film_aspect);
    float size = length(f[2]);
    slope = 2.0 * sqrt(abs(frame_volume(f / size)));
    return max(length(point - r.placement.world_from_local[3]), 1e-12) * slope;
}
