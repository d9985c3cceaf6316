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
    if (in_volume(s) || is_in_volume(y)) return in_volume(s) && is_in_volume(y) && y.normal == s.sides.above.medium;
    return dot(decode_octahedral_16(y.normal), s.normal) > 0.7 && abs(dot(y.position - p.position, s.normal)) < 0.5 * radius;
}

// What merging has brought so far.
struct Merging {
    GridQuery query;
    float radius;
    Collected inner, outer;  // of vertices within radius / sqrt(2), and beyond
};

void begin_merging(out Merging m, SurfacePoint p) {
    m.radius = merge_radius(p.position);
    m.inner = m.outer = nothing_collected();
    begin_query(m.query, p.position, m.radius);
}

// Does the vertex merge, that lies within the radius? Then `wi` is the direction, in the frame, that its light comes from.
bool merges_with(Merging m, Path path, SurfacePoint p, ScatteringPoint s, LightVertex y, out vec3 wi) {
    vec3 light_direction = decode_octahedral(y.direction);
    wi = light_direction * s.frame;
    return shares_hero(path, y) && lies_on_same(p, s, y, m.radius) && is_on_one_side(s, light_direction, wi);
}

void merge_vertex(inout Merging m, Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis, LightVertex y, Scattering pair) {
    vec3 light_direction = decode_octahedral(y.direction);
    vec3 d = y.position - p.position;
    float cosine = in_volume(s) ? 1.0 : dot(light_direction, s.normal);
    float reverse = pair.pdf_reverse * frame_probability(s, light_direction, -path.direction);
    float others = connects(path) * mis.vcm + reverse * mis.vc + CONNECTION_SHARE * y.vcm + pair.pdf * y.vc;
    Spectrum brought = pair.value * y.throughput * (mis.merging / (abs(cosine) * (mis.merging + others)));
    Brought light = brought_through(path, s, light_direction, y, merged_light(brought, path, s, pair.mueller, y));
    if (2.0 * dot(d, d) < square(m.radius)) collect(m.inner, light);
    else collect(m.outer, light);
}

void end_merging(Merging m, inout Path path, SurfacePoint p, ScatteringPoint s) {
    Spectrum scale = path.throughput * (forward_pass.path_flux / merge_size(in_volume(s), m.radius));
    if (in_volume(s)) {
        Spectrum scattering = medium_scattering(s.sides.above.medium, p.position);
        scale = mix(scale / scattering, Spectrum(0), lessThanEqual(scattering, Spectrum(0)));
    }
    add_collected(path.radiance, scaled(sum_of(m.inner, m.outer), scale));
    float inner_share = in_volume(s) ? 2.0 * sqrt(2.0) - 1.0 : 1.0;  // size of the ball or disk over that of the smaller, less one
    add_collected(path.bias, scaled(difference(m.outer, times(m.inner, inner_share)), scale));
}
