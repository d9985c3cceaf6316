// A rectangle in the xy plane around the origin, facing +z. Seen from there u runs to the right (+x), v down (-y).
//
// Example:
//     {"nodes": [{"name": "rectangle", "translation": [0, 0.4, 0], "rotation": [-0.2588, 0, 0, 0.9659], "extensions": {"ETD_optics": {
//         "geometry": {"class": "rectangle", "size": [1.1, 0.7], "material": 1}}}}]}

struct Rectangle {
    vec2 size;  //: required in (0, inf) m. Width along x and height along y.
};

bool rectangle_intersect(Rectangle r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    float t = direction.z != 0.0 ? -origin.z / direction.z : 0.0;
    vec2 p = origin.xy + t * direction.xy;
    hit = GeometryHit(t, p);
    return t > 0.0 && t < t_max && all(lessThanEqual(abs(p), 0.5 * r.size));
}

LocalPoint rectangle_locate(Rectangle r, vec3 origin, vec3 direction, GeometryHit hit) {
    // On the plane exactly.
    return LocalPoint(vec3(hit.uv, 0.0), vec3(0), vec3(0, 0, 1), vec3(1, 0, 0),
                      0.5 + vec2(hit.uv.x, -hit.uv.y) / r.size);
}

float rectangle_area(Rectangle r) { return r.size.x * r.size.y; }

GeometrySample rectangle_sample(Rectangle r, vec2 u) {
    return GeometrySample(vec3((u - 0.5) * r.size, 0.0), vec3(0, 0, 1), 1.0 / rectangle_area(r));
}

GeometrySample rectangle_sample_towards(Rectangle r, vec3 reference, vec2 u) { return rectangle_sample(r, u); }

float rectangle_pdf_towards(Rectangle r, vec3 reference, vec3 position, vec3 normal) {
    return 1.0 / rectangle_area(r);
}

void rectangle_bounds(Rectangle r, out vec3 lo, out vec3 hi) {
    hi = vec3(0.5 * r.size, 0.0);
    lo = -hi;
}
