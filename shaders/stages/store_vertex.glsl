// Keeps a vertex of a forward path for the backward paths of the same pass.
#include "lib/events.glsl"
#include "lib/vertex_grid.glsl"

void store_vertex(inout Path path, uint path_index, SurfacePoint p, ScatteringPoint s, Hit hit, VertexMis mis) {
    bool merges = MERGE_VERTICES == 1 && (path.flags & PATH_AFTER_NARROW) != 0u;
    if (mis.along) merges = mis.merging > 0.0;
    LightVertex v;
    v.position = p.position;
    v.vcm = mis.vcm;
    v.throughput = path.throughput;
    v.vc = mis.vc;
    v.direction = encode_octahedral(-path.direction);
    keep_polarization(v, path);
    keep_history(v, path);
    v.normal = in_volume(s) ? path.around.medium : encode_octahedral_16(p.geometric_normal);
    v.instance = hit.instance;
    v.uv = hit.uv;
    v.primitive = in_volume(s) ? NO_RECORD : hit.primitive;
    keep_medium_above(v, s.sides.above.medium);
    uint starts = (path.flags & PATH_STARTS) != 0u ? VERTEX_STARTS : 0u;
    v.previous = light_vertex_link(path.vertices.x, starts | (merges ? LIGHT_VERTEX_MERGES : 0u));
    uint place = append_light_vertex(v);
    if (place == NO_LIGHT_VERTEX) return;  // the host repeats the pass with fewer paths
    float radius = merge_radius(p.position) * (mis.along ? BEAM_CELL_SCALE : 1.0);
    if (merges) enter_grid(place, p.position, radius, path.vertices.y * forward_pass.count + path_index);
    path.vertices = uvec2(place, path.vertices.y + 1u);
}
