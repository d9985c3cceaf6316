// A meter on the surface of a mesh: on each triangle the illuminance of its front and of its back, and the exitance of both, which is all
// that leaves a side: emitted, reflected, let through. Light passes as if the meter were not there. The picture has four parts, one below
// the other: illuminance of the front, of the back, exitance of the front, of the back; in each the triangles stand row by row in the order
// of the mesh, in about as many columns as rows, and a pixel is the mean over its triangle. Places behind the last triangle are black.
// Meshes of bodies with a priority are no place for it. A pixel: lx.
//
// Example:
//     {"nodes": [{"name": "floor", "extensions": {"ETD_optics": {"receiver": {"class": "surface", "mesh": "light tiles"}}}}]}
#include "features/clearance.glsl"
#include "lib/primitives.glsl"

// Twin: host/scene/watched_surface.h.
struct WatchedSurface {
    uint first;    // in watched_words: the primitive of each triangle; behind them the triangle of each primitive, or NO_RECORD
    uint count;    // triangles
    uint columns, rows;  // of each part of the picture
    float area;    // m², of one side
};
layout(scalar, set = 0) readonly buffer WatchedWords { uint watched_words[]; };

struct SurfaceMeter {
    Placement placement;
    WatchedSurface mesh;  //: none. Name or index of a mesh, wherever it stands, or name of a node that has one (as `node` also its index); without it the mesh of this node.
};
#define receiver_surface_HAS_APERTURE

const uint SURFACE_PARTS = 4u;

float receiver_surface_pixels(SurfaceMeter r) { return float(SURFACE_PARTS * r.mesh.columns * r.mesh.rows); }

// What a point of the picture is of. False: nothing.
bool receiver_surface_find(SurfaceMeter r, vec2 film, out uint primitive, out uint part, out vec2 within) {
    float y = film.y * float(SURFACE_PARTS);
    part = min(uint(y), SURFACE_PARTS - 1u);
    vec2 place = vec2(film.x, y - float(part)) * vec2(r.mesh.columns, r.mesh.rows);
    uvec2 cell = min(uvec2(max(place, 0.0)), uvec2(r.mesh.columns, r.mesh.rows) - 1u);
    uint triangle = cell.y * r.mesh.columns + cell.x;
    within = clamp(place - vec2(cell), 0.0, 1.0);
    primitive = watched_words[r.mesh.first + min(triangle, r.mesh.count - 1u)];
    return triangle < r.mesh.count;
}

// Illuminance: receptors on the side, that face away from it. Exitance: rays that come to the side from a hair above it.
CameraRay receiver_surface_emit(SurfaceMeter r, vec2 film, vec2 u, float film_aspect) {
    uint primitive, part;
    vec2 within;
    bool exists = receiver_surface_find(r, film, primitive, part, within);
    Triangle t = primitives[primitive];
    LocalPoint p = triangle_locate(t, vec3(0), vec3(0), GeometryHit(0.0, warp_triangle(within)));
    vec3 normal = (part & 1u) == 0u ? p.normal : -p.normal;
    float density = exists ? 1.0 / (triangle_area(t) * receiver_surface_pixels(r)) : INFINITY;
    float weight = exists ? PI : 0.0;
    if (part < 2u) return CameraRay(p.position, -normal, weight, density, 1.0, true, true, 0u);
    vec3 origin = offset_origin(p.position + clearance(t, p.position) * normal, 4.0 * p.error, normal, normal);
    return CameraRay(origin, -(frame_around(normal) * warp_cosine_hemisphere(u)), weight, density * INV_PI, 0.0, true, false, 0u);
}

// Points are not connected to it: rays are caught where they meet the mesh, and where they leave it.
ReceiverSample receiver_surface_connect(SurfaceMeter r, vec3 point, vec2 u, float film_aspect) { return no_receiver_sample(); }
ReceptorHit receiver_surface_receptor(SurfaceMeter r, vec3 origin, vec3 direction) { return no_receptor_hit(); }

// Barycentric coordinates of the last two corners, of a point on the triangle.
vec2 receiver_surface_place(Triangle t, vec3 point) {
    vec3 e1 = t.v1 - t.v0, e2 = t.v2 - t.v0, d = point - t.v0, n = cross(e1, e2);
    return vec2(dot(cross(d, e2), n), dot(cross(e1, d), n)) / dot(n, n);
}

ReceiverSample receiver_surface_at_surface(SurfaceMeter r, uint primitive, vec3 point, bool front, bool leaves) {
    uint triangle = watched_words[r.mesh.first + r.mesh.count + primitive];
    if (triangle == NO_RECORD) return no_receiver_sample();
    Triangle t = primitives[primitive];
    vec3 normal = front ? triangle_normal(t) : -triangle_normal(t);
    uint part = (leaves ? 2u : 0u) + (front ? 0u : 1u);
    // Within the triangle's part of the picture, for pictures that are finer than one pixel a triangle.
    vec2 within = clamp(unwarp_triangle(receiver_surface_place(t, point)), 0.001, 0.999);
    vec2 film = (vec2(triangle % r.mesh.columns, part * r.mesh.rows + triangle / r.mesh.columns) + within) /
                vec2(r.mesh.columns, SURFACE_PARTS * r.mesh.rows);
    float density = 1.0 / (triangle_area(t) * receiver_surface_pixels(r));
    return ReceiverSample(normal, 0.0, film, leaves ? density * INV_PI : density, PI, 1.0);
}

uint receiver_surface_face(SurfaceMeter r, vec2 film, out bool front) {
    uint primitive, part;
    vec2 within;
    receiver_surface_find(r, film, primitive, part, within);
    front = (part & 1u) == 0u;
    return primitive;
}

float receiver_surface_footprint(SurfaceMeter r, vec3 point, float film_aspect, out float slope) {
    slope = 0.0;
    return sqrt(float(SURFACE_PARTS) * r.mesh.area);
}
