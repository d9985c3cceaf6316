// Merges a vertex of a backward path with the forward vertices around it: the flux that they bring per area is the
// irradiance (Jensen 1996), weighted against the other ways to make the paths (Georgiev et al. 2012).
//
// Only vertices of the same surface count: their normals agree within 45 degrees and they lie nearer to the plane of the
// vertex than half the radius. On planes and spheres the area within the radius is exactly pi r².
//
// The estimate is that of a box kernel, whose bias grows with r². The difference to the estimate with radius r / sqrt(2),
// from the same vertices, is half that bias: it is kept beside the image.
//
// Within a medium the disk is a ball, and vertices of the same medium count. Theirs and the backward one's throughput both hold the
// scattering coefficient, of which one is taken back: what is wanted is the flux that passes, not that which scatters.
#include "lib/events.glsl"
#include "lib/vertex_grid.glsl"

// Whether forward vertex y lies on the surface of the backward one, or in its medium.
bool lies_on_same(SurfacePoint p, ScatteringPoint s, LightVertex y, float radius) {
#if HAS_SCATTERING
    if (in_volume(s) || y.primitive == NO_RECORD)
        return in_volume(s) && y.primitive == NO_RECORD && y.normal == s.medium_above;
#endif
    return dot(decode_octahedral_16(y.normal), s.normal) > 0.7 && abs(dot(y.position - p.position, s.normal)) < 0.5 * radius;
}

void merge_vertices(inout Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis) {
    float radius = merge_radius(p.position);
    Spectrum inner = Spectrum(0), outer = Spectrum(0);
    GridQuery query;
    begin_query(query, p.position, radius);
    uint index;
    vec3 position;
    while (next_candidate(query, index, position)) {
        LightVertex y = light_vertices[index];
        vec3 light_direction = decode_octahedral(y.direction);
        vec3 d = y.position - p.position;
        float cosine = in_volume(s) ? 1.0 : dot(light_direction, s.normal);
        vec3 wi = light_direction * s.frame;
        if (!lies_on_same(p, s, y, radius) || !is_on_one_side(s, light_direction, wi)) continue;
        SurfacePair pair = scattering_pair(s, wi);
        float reverse = pair.pdf_reverse * frame_probability(s, light_direction, -path.direction);
        float others = connects(path) * mis.vcm + reverse * mis.vc + CONNECTION_SHARE * y.vcm + pair.pdf * y.vc;
        Spectrum brought = pair.value * y.throughput * (mis.merging / (abs(cosine) * (mis.merging + others)));
        brought *= meeting_share(path, y.previous);
        if (2.0 * dot(d, d) < square(radius)) inner += brought;
        else outer += brought;
    }
    Spectrum scale = path.throughput * (forward_pass.path_flux / merge_size(in_volume(s), radius));
#if HAS_SCATTERING
    if (in_volume(s)) {
        Spectrum scattering = medium_scattering(s.medium_above, p.position);
        scale = mix(scale / scattering, Spectrum(0), lessThanEqual(scattering, Spectrum(0)));
    }
#endif
    path.radiance += scale * (inner + outer);
    float inner_share = in_volume(s) ? 2.0 * sqrt(2.0) - 1.0 : 1.0;  // size of the ball or disk over that of the smaller, less one
    path.bias += scale * (outer - inner_share * inner);
}
