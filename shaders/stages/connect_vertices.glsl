// Connects a vertex of a backward path with one vertex of a forward path of the same pass, both drawn uniformly.
#include "lib/events.glsl"
#include "lib/light_vertices.glsl"

layout(scalar, set = 0) readonly buffer PathEnds { uvec2 path_ends[]; };  // per forward path: last stored vertex, their number

// A way from the backward vertex to a forward one.
struct Connection {
    bool is_there;
    LightVertex y;
    uint vertices;  // that y was drawn from
    vec3 direction;
    float distance;
    vec3 wi;        // the direction in the frame of the backward vertex
};

Connection no_connection(vec3 wi) {
    Connection c;
    c.is_there = false, c.wi = wi;
    return c;
}

// `here`: scattering at the backward vertex towards the forward one.
bool connects_to(Connection c, Scattering here) { return c.is_there && !is_black(here.value); }

Connection choose_vertex(inout Path path, SurfacePoint p, ScatteringPoint s) {
    Connection c;
    vec2 u = sample_2d(path.random);
    uvec2 end = path_ends[min(uint(u.x * float(forward_pass.count)), forward_pass.count - 1u)];
    c.vertices = end.y;
    uint index = end.x;
    for (uint steps = min(uint(u.y * float(end.y)), end.y - 1u); end.y > 0u && steps > 0u; --steps)
        index = light_vertices[index].previous & ~LIGHT_VERTEX_FLAGS;
    c.y = light_vertices[end.y > 0u ? index : 0u];
    vec3 d = c.y.position - p.position;
    c.distance = sqrt(dot(d, d));
    c.direction = d / c.distance;
    c.wi = c.direction * s.frame;
    c.is_there = end.y > 0u && c.distance > 0.0 && is_on_one_side(s, c.direction, c.wi) && shares_hero(path, c.y);
    if (!c.is_there) c.wi = vec3(0, 0, 1);
    return c;
}

// The forward vertex, as it scatters towards the backward one at s.
ScatteringPoint forward_point(Connection c, ScatteringPoint s) {
    vec3 light_direction = decode_octahedral(c.y.direction);
    // A shadow ray goes straight: only boundaries lie on it, index-matched by definition, so what is around here holds there.
    Surroundings around = surroundings_towards(s, c.direction);
    ScatteringPoint there;
    if (is_in_volume(c.y)) {
        there = volume_scattering_point(c.y.position, -light_direction, surroundings_of(c.y.normal), true);
    } else {
        SurfacePoint q = locate(Hit(0.0, c.y.uv, c.y.primitive, c.y.instance), c.y.position, -light_direction);
        uint own = take_hero_of(c.y);
        there = shaded_point(q, -light_direction, crossing_of_vertex(c.y, q.material, around), true);
        take_hero(own);
    }
    keep_object(there, false, c.y.primitive, c.y.instance);
    if (!is_consistent(there, -c.direction)) flatten(there, -light_direction);
    return there;
}

// `here` and `away`: scattering at both ends, `away` at `there`.
ShadowRay connect_vertices(Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis, Connection c, Scattering here,
                           ScatteringPoint there, Scattering away) {
    vec3 light_direction = decode_octahedral(c.y.direction);
    float frame = frame_probability(there, light_direction, -c.direction);
    if (!(frame > 0.0)) return no_shadow_ray();
    float distance_squared = square(c.distance);
    float cos_here = catch_density(s, c.direction), cos_there = catch_density(there, c.direction);
    float towards_there = here.pdf * cos_there / distance_squared;
    float towards_here = away.pdf * frame * cos_here / distance_squared;
    float reverse = here.pdf_reverse * frame_probability(s, c.direction, -path.direction);
    bool merges_there = (c.y.previous & LIGHT_VERTEX_MERGES) != 0u &&
                        (is_narrow(s.material) || is_short_edge(c.y.position, p.position));
    float merging_there = merges_there ? merge_density(in_volume(there), c.y.position) : 0.0;
    float merging_apart = 0.0;
    bool along_there = in_volume(there) && merges_along(c.y.normal);
    if (along_there) {
        merging_there = 0.0;
        if (merges_there && is_narrow(s.material)) merging_apart = towards_there * beam_density(there.extinction, c.y.position);
    }
    bool merges_here = is_narrow(there.material);
    if (mis.along && along_there) merges_here = is_short_edge(p.position, c.y.position);
    float merging_here = merges_here ? mis.merging : 0.0;
    float connects_there = (c.y.previous & VERTEX_STARTS) != 0u ? 1.0 : CONNECTION_SHARE;
    float by_backward = towards_there * (merging_there + connects_there * c.y.vcm + away.pdf_reverse * c.y.vc);
    float by_forward = towards_here * (merging_here + connects(path) * mis.vcm + reverse * mis.vc);

    float flux = forward_pass.path_flux * float(forward_pass.count) * float(c.vertices);  // one path and vertex stand for all
    Spectrum contribution = path.throughput * here.value * c.y.throughput * away.value *
                            (adjoint_correction(there, light_direction, -c.direction) * flux / distance_squared);
    ShadowRay shadow =
        shadow_ray(path, p, s, here, c.direction, c.distance, contribution, (by_backward + by_forward) / CONNECTION_SHARE);
    polarize_end(shadow, c.y, there, away.mueller);
    come_to_vertex(shadow, c.y, there, light_direction);
    weigh_apart(shadow, merging_apart / CONNECTION_SHARE);
    return shadow;
}
