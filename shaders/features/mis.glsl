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
#include "features/beams.glsl"
#include "features/dispersion.glsl"
#include "features/elements.glsl"
#include "features/merging.glsl"
#include "features/weights.glsl"
#include "interfaces/light_source.glsl"
#include "interfaces/receiver.glsl"
#include "lib/forward_pass.glsl"
#include "features/light_emission.glsl"
#include "features/light_selection.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"

// The quantities of a path at its newest vertex, per area there.
struct VertexMis {
    float vcm;
    float vc;
    float merging;  // merge_size times the number of forward paths; 0 where the path's own side forbids merging
    bool along;     // in a medium where rays merge; `merging` of a forward path lacks the passage of that ray then
};

// Vertices are connected with one of several of a forward path: that counts as so much of a connection to each. (Any number is
// right; about 1 / vertices of a path is best.)
const float CONNECTION_SHARE = CONNECT_VERTICES == 1 ? 0.3 : 0.0;

// How often the newest vertex is connected to from the other side: the first of a path always, by sampling lights or connecting to
// the receiver.
float connects(Path path) {
    if ((path.flags & PATH_STARTS) != 0u) return 1.0;
    return within_element(path) ? 0.0 : CONNECTION_SHARE;
}

// Flags of a light vertex.
const uint VERTEX_STARTS = 0x20000000u;      // the first of its path

#if BIDIRECTIONAL
#if FORWARD
void start_forward_weights(inout Path path, float density, bool is_delta, uint light, vec3 normal) {
    // vcm: times the density of sampling the light, known at the first vertex.
    start_weights(path, 1.0 / density, is_delta ? 0.0 : 1.0 / density);
    path.light = light;
    path.light_normal = normal;
}

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
    m.along = in_volume(s) && merges_along(path.around.medium);
#if FORWARD
    m.vcm = path.vcm * to_area * (starts ? start_connection_pdf(path, p.position) : distance_squared);
    m.merging = after_narrow ? merge_density(in_volume(s), p.position) : 0.0;
    bool from_beam = (path.flags & PATH_AFTER_BEAM) != 0u && is_short_edge(p.position, path.reference);
    if (m.along) m.merging = after_narrow || from_beam ? beam_density(s.extinction, p.position) : 0.0;
    bool merged_before = is_narrow(p.material) || is_short_edge(path.reference, p.position);
#else
    m.vcm = path.vcm * to_area * (starts && (path.flags & PATH_PARALLEL) != 0u ? 1.0 : distance_squared);
    bool merges = starts || after_narrow || is_short_edge(p.position, path.reference);
    m.merging = merges ? merge_density(in_volume(s), p.position) : 0.0;
    if (m.along) m.merging = after_narrow ? beam_density(s.extinction, p.position) / max(passage_of(path), 1e-30) : 0.0;
    bool merged_before = is_narrow(p.material);
#endif
    m.vcm /= passage_of(path);
    if (comes_from_beam(path)) {
#if FORWARD
        path.pending /= max(passage_of(path), 1e-30);
        merged_before = is_narrow(p.material);
#else
        merged_before = merged_before || (m.along && is_short_edge(path.reference, p.position));
#endif
    }
    m.vc = (path.vc + (merged_before ? path.pending : 0.0)) * to_area;
    if (within_element(path)) m.merging = 0.0, m.along = false;
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
    path.flags &= ~(PATH_STARTS | PATH_PARALLEL | PATH_AFTER_NARROW | PATH_AFTER_BEAM);
    if (m.along) path.flags |= PATH_AFTER_BEAM;
    if (is_narrow(material)) path.flags |= PATH_AFTER_NARROW;
}

// What of the emission of `light` the path's ray may hit other ways bring, too: light sampled from the reference with this density
// (1/sr), forward paths.
float others_of_hit(Path path, uint light, LightHit hit, float sampling) {
    float emission = light_pdf_emit(lights[light], scene_bounds(), path.direction, hit) * emitter_probability(light);
    if ((path.flags & PATH_STARTS) != 0u) sampling = 0.0;
    return sampling * path.vcm / passage_of(path) + emission * path.vc;
}
bool hit_stands_alone(Path path) { return (path.flags & PATH_STARTS) != 0u && !((HAS_FAR_RECEIVERS == 1 || HAS_SURFACE_METERS == 1) && path.vc > 0.0); }

// … of a light sample, by rays that hit the light and by forward paths.
float others_of_light_sample(Path path, ScatteringPoint s, LightSample l, uint light, Scattering pair, VertexMis mis) {
    float by_hit = l.is_delta ? 0.0 : pair.pdf;
    float emission = l.emission_pdf * emitter_probability(light) * catch_density(s, l.direction);
    float reverse = pair.pdf_reverse * frame_probability(s, l.direction, -path.direction);
    return (by_hit + emission * (connects(path) * mis.vcm + reverse * mis.vc)) / l.pdf;
}

// … of a connection to the receiver, which has this importance there (of one pixel). Its rays do not merge in media where others do.
float others_of_receiver_sample(Path path, ScatteringPoint s, vec3 direction, float importance, Scattering pair, VertexMis mis) {
    float backward = importance * catch_density(s, direction) / float(forward_pass.count);
    float merging = mis.along ? 0.0 : mis.merging;
    return backward * (merging + connects(path) * mis.vcm + pair.pdf_reverse * mis.vc);
}

// … of light that escapes to a receiver far away, to which connections choose its direction with this density (1/sr).
float others_of_escape(Path path, float importance, float connecting) {
    if ((path.flags & PATH_STARTS) != 0u) connecting = 0.0;
    float merging = comes_from_beam(path) ? 0.0 : path.pending;
    return connecting * path.vcm / passage_of(path) + importance / float(forward_pass.count) * (path.vc + merging);
}

#else
#define start_forward_weights(path, density, is_delta, light, normal)
#define vertex_mis(path, p, s) VertexMis(0.0, 0.0, 0.0, false)
#define update_mis(path, m, material, b, pdf_reverse, cosine)

#define others_of_hit(path, light, hit, sampling) (sampling / (path.pdf * passage_of(path)))
#define hit_stands_alone(path) (!(path.pdf > 0.0))
#define others_of_light_sample(path, s, l, light, pair, mis) ((l.is_delta ? 0.0 : pair.pdf) / l.pdf)
#define others_of_receiver_sample(path, s, direction, importance, pair, mis) 0.0
#define others_of_escape(path, importance, connecting) (path.pdf > 0.0 ? (connecting) / (path.pdf * passage_of(path)) : 0.0)
#endif
