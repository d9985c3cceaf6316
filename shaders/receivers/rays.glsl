// A recorder of rays: what crosses a rectangle in the xy plane around the origin of its node from the side of +z, or what leaves a
// sphere around the origin. Light passes as if nothing were there. Its picture is the illuminance, columns along x, or of the sphere
// once about z from +x over +y, and rows downwards: along -y, or from the top of the sphere to its bottom, all of the same area.
// `etendue measure` writes the rays that have crossed it as a TM-25 file, which the light `rays` at the same node sends on; forward
// rays alone are recorded. Beyond `limit` they are an even sample of all. A pixel: lx.
//
// Example:
//     {"nodes": [{"name": "recorder", "translation": [0, 0.6, 0], "rotation": [0.7071, 0, 0, 0.7071], "extensions": {"ETD_optics": {
//         "receiver": {"class": "rays", "size": [1.6, 0.8], "resolution": [16, 8]}}}}]}
struct RayRecorder {
    Placement placement;
    vec2 size;        //: [1, 1] in (0, inf) m. Width along x and height along y of the rectangle.
    float radius;     //: 0 in [0, inf) m. Of a sphere in its place; of the node's scale it takes the mean.
    vec2 resolution;  //: [1, 1] in [1, 16384]. Pixels of the picture.
    float limit;      //: 1000000 in [1, 100000000]. Rays in the file at most.
};
#define receiver_rays_RECORDS_RAYS 1

// Of the sphere, m.
float receiver_rays_radius(RayRecorder r) {
    mat4x3 m = r.placement.world_from_local;
    return r.radius * pow(abs(dot(cross(m[0], m[1]), m[2])), 1.0 / 3.0);
}

// Of the rectangle, towards +z, and its area, m².
vec3 receiver_rays_normal(RayRecorder r, out float area) {
    mat4x3 m = r.placement.world_from_local;
    vec3 n = cross(m[0], m[1]);
    float l = length(n);
    area = l * r.size.x * r.size.y;
    return (dot(n, m[2]) < 0.0 ? -n : n) / l;
}

// The point of the picture, towards where its light comes from.
vec3 receiver_rays_point(RayRecorder r, vec2 film, out vec3 normal, out float area) {
    mat4x3 m = r.placement.world_from_local;
    if (r.radius > 0.0) {
        float radius = receiver_rays_radius(r), z = 1.0 - 2.0 * film.y;
        normal = -(node_frame(m) * vec3(sqrt(max(1.0 - z * z, 0.0)) * cos_sin_turns(film.x), z));
        area = 4.0 * PI * radius * radius;
        return m[3] - radius * normal;
    }
    normal = receiver_rays_normal(r, area);
    return m * vec4((film.x - 0.5) * r.size.x, (0.5 - film.y) * r.size.y, 0.0, 1.0);
}

// Of a point on the rectangle, in sizes from the middle.
vec2 receiver_rays_place(RayRecorder r, vec3 normal, vec3 point) {
    mat4x3 m = r.placement.world_from_local;
    mat3 f = mat3(m[0] * r.size.x, m[1] * r.size.y, normal);
    return scaled_local(f, point - m[3]).xy / abs(frame_volume(f));
}

// As those of an illuminance meter (receivers/illuminance.glsl).
CameraRay receiver_rays_emit(RayRecorder r, vec2 film, vec2 u, float film_aspect) {
    vec3 normal;
    float area;
    vec3 origin = receiver_rays_point(r, film, normal, area);
    return CameraRay(origin, -normal, PI, 1.0 / area, 1.0, true, true, 0u);
}

ReceiverSample receiver_rays_connect(RayRecorder r, vec3 point, vec2 u, float film_aspect) {
    float area;
    vec3 normal = receiver_rays_normal(r, area);
    vec2 film;
    if (r.radius > 0.0) {
        float radius = receiver_rays_radius(r);
        area = 4.0 * PI * radius * radius;
        normal = -normalize(point - r.placement.world_from_local[3]);
        vec3 local = -normal * node_frame(r.placement.world_from_local);
        float turns = accurate_atan2(local.y, local.x) * (0.5 * INV_PI);
        film = vec2(turns - floor(turns), 0.5 - 0.5 * local.z);
    } else {
        vec2 place = receiver_rays_place(r, normal, point);
        film = vec2(0.5 + place.x, 0.5 - place.y);
    }
    return ReceiverSample(normal, 0.0, clamp(film, 0.0, 1.0), 1.0 / area, PI, 1.0);
}

ReceptorHit receiver_rays_receptor(RayRecorder r, vec3 origin, vec3 direction) {
    mat4x3 m = r.placement.world_from_local;
    if (r.radius > 0.0) {
        // Where the ray leaves the sphere: of the two roots the greater one, by the nearest point to the centre.
        vec3 to_center = m[3] - origin;
        float middle = dot(to_center, direction), radius = receiver_rays_radius(r);
        vec3 off = to_center - middle * direction;
        float s = radius * radius - dot(off, off);
        if (!(s > 0.0)) return no_receptor_hit();
        float t = middle + sqrt(s);
        if (!(t > 0.0)) return no_receptor_hit();
        return ReceptorHit(t, normalize(to_center - t * direction), 0u);
    }
    float area;
    vec3 normal = receiver_rays_normal(r, area);
    float facing = -dot(direction, normal), t = dot(origin - m[3], normal) / facing;
    if (!(facing > 0.0) || !(t > 0.0) || isinf(t)) return no_receptor_hit();
    if (any(greaterThan(abs(receiver_rays_place(r, normal, origin + t * direction)), vec2(0.5)))) return no_receptor_hit();
    return ReceptorHit(t, normal, 0u);
}

float receiver_rays_footprint(RayRecorder r, vec3 point, float film_aspect, out float slope) {
    float area;
    receiver_rays_normal(r, area);
    slope = 0.0;
    return r.radius > 0.0 ? 2.0 * sqrt(PI) * receiver_rays_radius(r) : sqrt(area);
}
