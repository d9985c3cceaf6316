// Where paths of both directions meet: forward paths keep their vertices, backward ones connect to them and merge with them.
#include "features/defaults.glsl"

#if FORWARD
#if CONNECT_VERTICES
#include "stages/store_vertex.glsl"
layout(scalar, set = 0) writeonly buffer PathEnds { uvec2 path_ends[]; };  // per path: last stored vertex, their number
void end_forward_path(uint path_index, Path path) { path_ends[path_index] = path.vertices; }
#else
#include "lib/events.glsl"
void store_vertex(inout Path path, uint path_index, SurfacePoint p, ScatteringPoint s, Hit hit, VertexMis mis) {}
void end_forward_path(uint path_index, Path path) {}
#endif

#else
#if CONNECT_VERTICES
#include "stages/connect_vertices.glsl"
#else
#include "lib/events.glsl"
struct Connection { vec3 wi; };
Connection no_connection(vec3 wi) { return Connection(wi); }
Connection choose_vertex(inout Sampler random, SurfacePoint p, ScatteringPoint s) { return no_connection(vec3(0)); }
#endif

#if MERGE_VERTICES
#include "stages/meet_vertices.glsl"
#elif CONNECT_VERTICES
ShadowRay meet_vertices(inout Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis, Connection c, SurfacePair here, bool merges) {
    if (!connects_to(c, here)) return no_shadow_ray();
    ScatteringPoint there = forward_point(c, s);
    return connect_vertices(path, p, s, mis, c, here, there, scattering_pair(there, -c.direction * there.frame));
}
#else
ShadowRay meet_vertices(inout Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis, Connection c, SurfacePair here, bool merges) {
    return no_shadow_ray();
}
#endif

#if BEAMS
#include "stages/merge_along.glsl"
#else
void merge_along(inout Path sum, Path path, float to_surface, float free_path) {}
#endif
#endif
