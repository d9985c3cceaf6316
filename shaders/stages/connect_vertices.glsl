// Connects a vertex of a backward path with one vertex of a forward path of the same pass, both drawn uniformly.
#include "lib/events.glsl"
#include "lib/light_vertices.glsl"

layout(scalar, set = 0) readonly buffer PathEnds { uvec2 path_ends[]; };  // per forward path: last stored vertex, their number

ShadowRay connect_vertices(inout Path path, SurfacePoint p, ScatteringPoint s, VertexMis mis) {
    vec2 u = sample_2d(path.random);
    uvec2 end = path_ends[min(uint(u.x * float(forward_pass.count)), forward_pass.count - 1u)];
    if (end.y == 0u) return no_shadow_ray();
    uint index = end.x;
    for (uint steps = min(uint(u.y * float(end.y)), end.y - 1u); steps > 0u; --steps)
        index = light_vertices[index].previous & ~LIGHT_VERTEX_FLAGS;
    LightVertex y = light_vertices[index];

    vec3 d = y.position - p.position;
    float distance_squared = dot(d, d);
    if (!(distance_squared > 0.0)) return no_shadow_ray();
    float distance = sqrt(distance_squared);
    vec3 direction = d / distance;
    vec3 wi = direction * s.frame;
    if (!is_on_one_side(s, direction, wi)) return no_shadow_ray();
    SurfacePair here = scattering_pair(s, wi);
    if (is_black(here.value)) return no_shadow_ray();

    vec3 light_direction = decode_octahedral(y.direction);
    ScatteringPoint there;
#if HAS_SCATTERING
    if (y.primitive == NO_RECORD)
        there = volume_scattering_point(y.position, -light_direction, y.normal, true);
    else
#endif
    {
        SurfacePoint q = locate(Hit(0.0, y.uv, y.primitive, y.instance), y.position, -light_direction);
        // A shadow ray goes straight: only boundaries lie on it, index-matched by definition, so the index here holds there.
        uint medium = scattering_medium(s, direction);
#if HAS_PRIORITIES
        if (materials[q.material].body != NO_RECORD) medium = y.medium_above;
#endif
        there = shaded_point(q, -light_direction, medium, true);
    }
    if (!is_consistent(there, -direction)) flatten(there, -light_direction);
    float frame = frame_probability(there, light_direction, -direction);
    if (!(frame > 0.0)) return no_shadow_ray();
    SurfacePair away = scattering_pair_of_any(there, -direction * there.frame);

    float cos_here = catch_density(s, direction), cos_there = catch_density(there, direction);
    float towards_there = here.pdf * cos_there / distance_squared;
    float towards_here = away.pdf * frame * cos_here / distance_squared;
    float reverse = here.pdf_reverse * frame_probability(s, direction, -path.direction);
    bool merges_there = (y.previous & LIGHT_VERTEX_MERGES) != 0u &&
                        (is_narrow(s.material) || is_short_edge(y.position, p.position));
    float merging_there = merges_there ? merge_density(in_volume(there), y.position) : 0.0;
#if BEAMS
    float merging_apart = 0.0;
    if (in_volume(there) && merges_along(y.normal)) {
        merging_there = 0.0;
        if (merges_there && is_narrow(s.material)) merging_apart = towards_there * beam_density(there, y.position);
    }
#endif
    bool merges_here = is_narrow(there.material);
#if BEAMS
    if (mis.along && in_volume(there) && merges_along(y.normal)) merges_here = is_short_edge(p.position, y.position);
#endif
    float merging_here = merges_here ? mis.merging : 0.0;
    float connects_there = (y.previous & VERTEX_STARTS) != 0u ? 1.0 : CONNECTION_SHARE;
    float by_backward = towards_there * (merging_there + connects_there * y.vcm + away.pdf_reverse * y.vc);
    float by_forward = towards_here * (merging_here + connects(path) * mis.vcm + reverse * mis.vc);

    float flux = forward_pass.path_flux * float(forward_pass.count) * float(end.y);  // one path and vertex stand for all
    Spectrum contribution = path.throughput * here.value * y.throughput * away.value *
                            (adjoint_correction(there, light_direction, -direction) * flux / distance_squared *
                             meeting_share(path, y.previous));
    ShadowRay shadow = shadow_ray(p, s, direction, distance, contribution, (by_backward + by_forward) / CONNECTION_SHARE);
#if BEAMS
    shadow.others_apart = merging_apart / CONNECTION_SHARE;
#endif
    return shadow;
}
