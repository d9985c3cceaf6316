// Merges a ray of a backward path with the forward vertices of its medium along it: the beam radiance estimate (Jarosz et al.
// 2008, "The Beam Radiance Estimate for Volumetric Photon Mapping"; P-B2D of Křivánek et al. 2014, "Unifying Points, Beams, and
// Paths in Volumetric Light Transport Simulation"), weighted against the other ways to make the paths (features/mis.glsl).
//
// A vertex counts where the ray passes within the vertex' radius r: its flux spreads evenly over a disk of pi r² across the ray.
// The ray brings passage times phase function times flux over that; the flux is what scatters, so that no coefficient is wanted.
//
// Only rays that come from narrow surfaces merge. Those of the receiver bring no more than forward vertices connected to it;
// those from points of the medium took 12 % of the time of glass_in_fog and lowered no error.
#include "lib/events.glsl"
#include "lib/beam_query.glsl"

// Optical depth of an average lane up to which vertices are always asked for. Those behind wait for a free path that ends no
// further before them, and make up for its probability: the end of a long ray brings little.
const float SURE_DEPTH = 1.0;

// How far along the ray vertices merge, m.
float merged_length(Path path, float to_surface) {
    if (within_element(path) || (path.flags & PATH_AFTER_NARROW) == 0u || !medium_scatters(path.around.medium)) return 0.0;
    if (!merges_along(path.around.medium)) return 0.0;
    float towards = dot(path.origin, path.direction);
    float left = square(towards) + square(BEAM_REACH) - dot(path.origin, path.origin);
    return min(to_surface, sqrt(max(left, 0.0)) - towards);
}

Passage passage_along(Path path, float distance) {
    return medium_pass(path.around.medium, MediumRay(path.origin, path.direction, distance, 0u), 0u);
}

// `path`: before its ray has crossed the medium; `free_path`: to where it scatters, or `to_surface`.
// `sum` receives what it brings.
void merge_along(inout Path sum, Path path, float to_surface, float free_path) {
    float length = merged_length(path, to_surface);
    if (!(length > 0.0)) return;
    float sure = SURE_DEPTH / max(medium_mean_extinction(path.around.medium, path.origin), 1e-30);
    if (free_path < to_surface) length = min(length, free_path + sure);
    // Of the lanes, one of which the free path is sampled for (lib/free_path.glsl).
    Spectrum share = path.throughput / max(dot(path.throughput, Spectrum(1)), 1e-30);
    Collected inner = nothing_collected(), outer = nothing_collected();
    BeamQuery query;
    float slope;
    merge_radius(path.origin, slope);
    begin_beam(query, path.origin, path.direction, length, slope);
    uint index;
    while (next_on_beam(query, index)) {
        LightVertex y = light_vertices[index];
        if (!is_in_volume(y) || y.normal != path.around.medium || !shares_hero(path, y)) continue;
        vec3 d = y.position - path.origin;
        float t = dot(d, path.direction);
        vec3 aside = d - t * path.direction;
        float radius = merge_radius(y.position);
        // To where all vertices are asked for, if this one is beyond, and to it: a loop, so that the code of media stands once.
        Passage passage;
        Spectrum waited = Spectrum(1);
        [[dont_unroll]] for (uint k = t > sure ? 0u : 1u; k < 2u; ++k) {
            passage = passage_along(path, k == 0u ? t - sure : t);
            if (k == 0u) waited = passage.transmittance;
        }
        ScatteringPoint s = volume_scattering_point(y.position, path.direction, path.around, false);
        Spectrum value = phase_value(s.phase, dot(decode_octahedral(y.direction), path.direction));
        float pdf = lane_mean(value);
        // As if the ray scattered there.
        Path met = path;
        lessen_passage(met, max(passage.mean, 1e-30));
        VertexMis mis = vertex_mis(met, volume_point(y.position, path.direction), s);
        if (!(mis.merging > 0.0)) continue;
        float others = connects(path) * mis.vcm + pdf * mis.vc + CONNECTION_SHARE * y.vcm + pdf * y.vc;
        float weight = mis.merging / (mis.merging + others);
        if (t > sure) weight /= max(dot(share, waited), 1e-30);
        Spectrum brought = passage.transmittance * y.throughput * value * (weight / (PI * square(radius)));
        vec3 light_direction = decode_octahedral(y.direction);
        Received merged = merged_light(brought, path, s, phase_mueller(s.phase, light_direction * s.frame, s.wo), y);
        Brought light = brought_through(path, s, light_direction, y, merged);
        if (2.0 * dot(aside, aside) < square(radius)) collect(inner, light);
        else collect(outer, light);
    }
    Spectrum scale = path.throughput * forward_pass.path_flux;
    add_collected(sum.radiance, scaled(sum_of(inner, outer), scale));
    add_collected(sum.bias, scaled(difference(outer, inner), scale));  // as for surfaces (stages/merge_vertices.glsl)
}
