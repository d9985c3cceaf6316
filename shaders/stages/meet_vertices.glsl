// Where backward paths meet forward ones: a vertex is connected with one forward vertex and merged with those around it.
//
// Both ask how surfaces of any class scatter, the one at the forward vertex, the other at the backward one for each candidate: in
// one loop, so that the code of all classes stands once. (Connections: stages/connect_vertices.glsl, or features/meeting.glsl says
// that there are none.)
#include "stages/merge_vertices.glsl"

// `here`: scattering at the backward vertex towards the forward one.
ShadowRay meet_vertices(inout Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis, Connection c, Scattering here,
                        bool merges) {
    ShadowRay shadow = no_shadow_ray();
    bool connects = connects_to(c, here);
    ScatteringPoint there = s;
    if (connects) there = forward_point(c, s);
    Merging merging;
    if (merges) begin_merging(merging, p);
    while (connects || merges) {
        ScatteringPoint at = there;
        vec3 wi = -c.direction * there.frame;
        LightVertex y = c.y;
        if (!connects) {
            uint index;
            vec3 position;
            if (!next_candidate(merging.query, index, position)) break;
            y = light_vertices[index];
            at = s;
            if (!merges_with(merging, path, p, s, y, wi)) continue;
        }
        Scattering pair = scattering_pair(at, wi);
        if (connects) shadow = connect_vertices(path, p, s, mis, c, here, there, pair);
        else merge_vertex(merging, path, p, s, mis, y, pair);
        connects = false;
    }
    if (merges) end_merging(merging, path, p, s);
    return shadow;
}
