// Multiple importance sampling over all ways to make a path: emission hit by a backward ray, light sampling, connection to
// the receiver, connection of vertices, merging of vertices. Balance heuristic in the recursive form of vertex connection
// and merging (Georgiev et al. 2012; Georgiev 2012, "Implementing Vertex Connection and Merging", eqs. 29 to 40).
//
// Differences from that report:
// - Densities of rays are per étendue (area perpendicular to the ray times solid angle), so lights and receivers near
//   and far, points and surfaces need no cases of their own.
// - Which light a point samples depends on the point, so a forward path learns the density of that only at its first hit.
// - Merging happens only at vertices that light reaches from a narrow surface (MATERIAL_NARROW), and leaves towards another,
//   towards the receiver, or towards a vertex nearby, where connections would have huge values: everything else is sampled well
//   enough without, and a query costs as much as a ray. A path learns whether it may have merged at a vertex one event later
//   (Path.pending).
// - Within a medium a vertex has no cosine: the extinction coefficient takes its place, since that is what of a ray is caught per
//   volume (Křivánek et al. 2014, "Unifying Points, Beams, and Paths in Volumetric Light Transport Simulation", section 3). Media
//   that scatter let a ray pass with some probability, which a connection does not need: ShadowRay.others waits for it. On both sides
//   of vc it cancels. Weights take the passage of an average lane, since the exact one depends on what a path carries.
// - In media that are the same everywhere whole rays that leave narrow surfaces merge, not only points where they scatter
//   (stages/merge_along.glsl): see beam_density(). They do so at vertices that light reaches from a narrow surface or, for the
//   sake of connections over short edges, from such a medium nearby.
// - The merging radius varies over space, so vc is kept without a twin in units of merging (dVM = dVC / density there).
#include "interfaces/light_source.glsl"
#include "interfaces/receiver.glsl"
#if FORWARD || BIDIRECTIONAL
#include "lib/forward_pass.glsl"
#include "lib/light_emission.glsl"
#endif
#include "lib/light_selection.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"

#if FORWARD || BIDIRECTIONAL
float film_aspect() { return float(forward_pass.width) / float(forward_pass.height); }
float pixel_count() { return float(forward_pass.width) * float(forward_pass.height); }
#endif

// The quantities of a path at its newest vertex, per area there.
struct VertexMis {
    float vcm;
    float vc;
    float merging;  // merge_size times the number of forward paths; 0 where the path's own side forbids merging
#if BEAMS
    bool along;     // in a medium where rays merge; `merging` of a forward path lacks the passage of that ray then
#endif
};

#if !BIDIRECTIONAL
VertexMis vertex_mis(Path path, SurfacePoint p, ScatteringPoint s) { return VertexMis(0.0, 0.0, 0.0); }
#else
#if MERGE_VERTICES
// Images of few pixels and wide angles get less than they ask for: lib/vertex_grid.glsl wants radii that change slowly.
float merge_scale() {
    float slope = receiver_footprint_slope(forward_pass.receiver, film_aspect());
    return min(forward_pass.merge_scale, 0.05 / max(slope, 1e-6));
}
float merge_radius(vec3 position) {
    return merge_scale() * receiver_footprint(forward_pass.receiver, position, film_aspect());
}
// Within it vertices merge: a disk of a surface, m², or a ball of a medium, m³.
float merge_size(bool in_volume, float radius) { return PI * square(radius) * (in_volume ? 4.0 / 3.0 * radius : 1.0); }
float merge_density(bool in_volume, vec3 position) {
    return merge_size(in_volume, merge_radius(position)) * float(forward_pass.count);
}
#if BEAMS
// From the scene's centre, m: a medium without end is left alone beyond it.
const float BEAM_REACH = 2.0 * SCENE_RADIUS;
// Whether rays merge with vertices in a medium along all their way, instead of points where they scatter. In media so dense that
// light scatters many times before it leaves there are many points, too, and rays cost more than they bring.
// Optical depth across the scene's radius. For glass_in_fog behind a pane rays were 1.4 times as efficient at 1.1, points at 4.4.
const float DENSEST_FOR_BEAMS = 3.5;
bool merges_along(uint medium) {
    return medium_is_even(medium) && medium_mean_extinction(medium, vec3(0)) * SCENE_RADIUS < DENSEST_FOR_BEAMS;
}
// As merge_density, of a vertex with a ray (the estimator P-B2D of Křivánek et al. 2014). A point merges with density
// p sigma T N 4/3 pi r³, where p is the density of the ray's direction per area at the vertex, T its passage to there, sigma the
// extinction coefficient, N the number of forward paths. A ray needs neither to get there nor to scatter there, and its disk is
// perpendicular to it: p N pi r². Paths count in units of p sigma T, so that this takes N pi r² / (sigma T); T is left to the
// caller.
float beam_density(ScatteringPoint s, vec3 position) {
    if (dot(position, position) > square(BEAM_REACH)) return 0.0;
    return PI * square(merge_radius(position)) * float(forward_pass.count) / max(s.extinction, 1e-30);
}
#endif
#else
float merge_density(bool in_volume, vec3 position) { return 0.0; }
#endif

// Whether the edge between a vertex that merges and the next one towards the receiver is short enough to ask for merging.
bool is_short_edge(vec3 merging, vec3 next) {
#if MERGE_VERTICES
    return distance(merging, next) < forward_pass.short_scale * receiver_footprint(forward_pass.receiver, merging, film_aspect());
#else
    return false;
#endif
}

bool is_narrow(uint material) {
#if HAS_SCATTERING
    if (material == NO_RECORD) return false;  // within a medium
#endif
    return (materials[material].flags & MATERIAL_NARROW) != 0u;
}

// Vertices are connected with one of several of a forward path: that counts as so much of a connection to each. (Any number is
// right; about 1 / vertices of a path is best.)
const float CONNECTION_SHARE = CONNECT_VERTICES == 1 ? 0.3 : 0.0;

// How often the newest vertex is connected to from the other side: the first of a path always, by sampling lights or connecting to
// the receiver.
float connects(Path path) { return (path.flags & PATH_STARTS) != 0u ? 1.0 : CONNECTION_SHARE; }

// Flags of a light vertex.
const uint VERTEX_STARTS = 0x20000000u;      // the first of its path
const uint VERTEX_MONOCHROME = 0x40000000u;  // its path carries the hero wavelength only

// Both paths alone would have their hero stand for all wavelengths; joined they do so once.
float meeting_share(Path path, uint vertex_flags) {
#if HAS_DISPERSION
    if ((path.flags & PATH_MONOCHROME) != 0u && (vertex_flags & VERTEX_MONOCHROME) != 0u) return 0.25;
#endif
    return 1.0;
}

#if FORWARD
// At the first vertex: the density with which it would sample the path's light the way the path came.
float start_connection_pdf(Path path, vec3 position) {
    LightHit hit = LightHit(path.reference, path.light_normal, vec2(0), vec2(0));
    return light_pdf_towards(lights[path.light], position, -path.direction, hit) *
           light_selection_probability(path.light, position);
}
#endif

VertexMis vertex_mis(Path path, SurfacePoint p, ScatteringPoint s) {
    VertexMis m;
    // A ray along the surface, to the last bit, has no density there: it counts as one that hardly meets it.
    float to_area = 1.0 / max(catch_density(s, path.direction), 1e-12);
    bool starts = (path.flags & PATH_STARTS) != 0u, after_narrow = (path.flags & PATH_AFTER_NARROW) != 0u;
    vec3 d = p.position - path.reference;
    float distance_squared = dot(d, d);
#if FORWARD
    m.vcm = path.vcm * to_area * (starts ? start_connection_pdf(path, p.position) : distance_squared);
    m.merging = after_narrow ? merge_density(in_volume(s), p.position) : 0.0;
#if BEAMS
    m.along = in_volume(s) && merges_along(path.medium);
    bool from_beam = (path.flags & PATH_AFTER_BEAM) != 0u && is_short_edge(p.position, path.reference);
    if (m.along) m.merging = after_narrow || from_beam ? beam_density(s, p.position) : 0.0;
#endif
    bool merged_before = is_narrow(p.material) || is_short_edge(path.reference, p.position);
#else
    m.vcm = path.vcm * to_area * (starts && (path.flags & PATH_PARALLEL) != 0u ? 1.0 : distance_squared);
    bool merges = starts || after_narrow || is_short_edge(p.position, path.reference);
    m.merging = merges ? merge_density(in_volume(s), p.position) : 0.0;
#if BEAMS
    m.along = in_volume(s) && merges_along(path.medium);
    if (m.along) m.merging = after_narrow ? beam_density(s, p.position) / max(path.passage, 1e-30) : 0.0;
#endif
    bool merged_before = is_narrow(p.material);
#endif
#if HAS_SCATTERING
    m.vcm /= path.passage;
#endif
#if BEAMS
    if ((path.flags & PATH_AFTER_BEAM) != 0u) {
#if FORWARD
        path.pending /= max(path.passage, 1e-30);
        merged_before = is_narrow(p.material);
#else
        merged_before = merged_before || (m.along && is_short_edge(path.reference, p.position));
#endif
    }
#endif
    m.vc = (path.vc + (merged_before ? path.pending : 0.0)) * to_area;
    return m;
}

// After an event that was no straight passage, with the pdf of the way back.
void update_mis(inout Path path, VertexMis m, uint material, BsdfSample b, float pdf_reverse, float cosine) {
    if ((b.event & EVENT_DELTA) != 0u) {
        path.vcm = 0.0;
        path.vc = m.vc * cosine;
        path.pending = 0.0;
    } else {
        float ratio = cosine / b.pdf;
        path.vc = ratio * (m.vc * pdf_reverse + connects(path) * m.vcm);
        path.pending = ratio * m.merging;
        path.vcm = 1.0 / b.pdf;
    }
    path.flags &= ~(PATH_STARTS | PATH_PARALLEL | PATH_AFTER_NARROW);
#if BEAMS
    path.flags = m.along ? path.flags | PATH_AFTER_BEAM : path.flags & ~PATH_AFTER_BEAM;
#endif
    if (is_narrow(material)) path.flags |= PATH_AFTER_NARROW;
}
#endif
