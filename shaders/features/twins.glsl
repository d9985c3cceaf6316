// Sheets of two triangles, one for each side, of which the hierarchy holds one: a ray that comes from behind sees the other
// (host/geometry/twins.h).
#if HAS_TWINS
layout(scalar) readonly buffer Twins { uint twins[]; };  // of each primitive; NO_RECORD = none

// `hit`: of a triangle by a ray along `direction`, both in its frame. The corners of twins stand in the order 0, 2, 1.
void show_front(inout Hit hit, Triangle r, vec3 direction) {
    if (!is_triangle(r.attributes) || dot(triangle_cross(r), direction) <= 0.0) return;
    uint twin = twins[hit.primitive];
    if (twin != NO_RECORD) hit.primitive = twin, hit.uv = hit.uv.yx;
}
#else
#define show_front(hit, r, direction)
#endif
