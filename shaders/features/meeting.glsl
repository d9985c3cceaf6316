// Where paths of both directions meet: forward paths keep their vertices, backward ones connect to them and merge with them, or
// only the one or the other: a kernel that connects knows the classes of both ends, one that merges that of its own vertex.
#include "features/defaults.glsl"

#if FORWARD
#if CONNECT_VERTICES || MERGE_VERTICES
#include "stages/store_vertex.glsl"
layout(scalar, set = 0) writeonly buffer PathEnds { uvec2 path_ends[]; };  // per path: last stored vertex, their number
void end_forward_path(uint path_index, Path path) { path_ends[path_index] = path.vertices; }
#else
#include "lib/events.glsl"
#define store_vertex(path, path_index, p, s, hit, mis)
#define end_forward_path(path_index, path)
#endif

#else
#include "stages/trace_shadow.glsl"
#if CONNECT_VERTICES
#include "stages/connect_vertices.glsl"
// Adds what the shadow rays of an event bring, one after the other, as all schedules do: a loop, so that the code stands once.
void trace_shadows(ShadowRay shadow, ShadowRay vertex_shadow, inout Collected radiance, inout Counters counters) {
    for (uint i = 0u; i < 2u; ++i) {
        collect(radiance, trace_shadow(shadow, counters));
        shadow = vertex_shadow;
    }
}
#else
#define trace_shadows(shadow, vertex_shadow, radiance, counters) collect(radiance, trace_shadow(shadow, counters))
#include "lib/events.glsl"
#include "lib/light_vertices.glsl"
struct Connection {
    vec3 wi, direction;
    LightVertex y;
};
Connection no_connection(vec3 wi) {
    Connection c;
    c.wi = wi;
    return c;
}
#define choose_vertex(path, p, s) no_connection(vec3(0, 0, 1))
#define connects_to(c, here) false
#define forward_point(c, s) s
#define connect_vertices(path, p, s, mis, c, here, there, pair) no_shadow_ray()
#endif

#if MERGE_VERTICES
#include "stages/meet_vertices.glsl"
#elif CONNECT_VERTICES
ShadowRay meet_vertices(inout Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis, Connection c, Scattering here, bool merges) {
    if (!connects_to(c, here)) return no_shadow_ray();
    ScatteringPoint there = forward_point(c, s);
    return connect_vertices(path, p, s, mis, c, here, there, scattering_pair(there, -c.direction * there.frame));
}
#else
#define meet_vertices(path, p, s, mis, c, here, merges) no_shadow_ray()
#endif

// Takes a path through its medium, as cross_medium(); where rays merge, with the vertices along its way.
#if BEAMS
#include "stages/merge_along.glsl"
bool cross_and_merge(inout Path path, inout Hit hit) {
    Path before = path;
    float to_surface = hit.t;
    bool scatters = cross_medium(path, hit);
    merge_along(path, before, to_surface, hit.t);
    return scatters;
}
#else
#define cross_and_merge(path, hit) cross_medium(path, hit)
#endif
#endif
