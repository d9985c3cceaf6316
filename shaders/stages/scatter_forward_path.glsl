// One event of a forward path: what the ray meets is crossed, connected to the receiver, stored, and scattered from.
#include "lib/events.glsl"
#include "lib/traversal.glsl"
#if CONNECT_VERTICES || MERGE_VERTICES
#include "stages/store_vertex.glsl"
#endif

// The ray that brings light from the point to the receiver.
ShadowRay connect_receiver(Path path, SurfacePoint p, ScatteringPoint s, ReceiverSample r, SurfacePair pair,
                           VertexMis mis) {
    float frame = frame_probability(s, -path.direction, r.direction);
    if (is_black(pair.value) || !is_seen_from(s, r.direction) || !(frame > 0.0)) return no_shadow_ray();
    float importance = r.density * pixel_count() / r.pdf;  // of one pixel
    float others = 0.0;
#if BEAMS
    if (mis.along) mis.merging = 0.0;  // rays of the receiver do not merge
#endif
#if BIDIRECTIONAL
    float backward = importance * catch_density(s, r.direction) / float(forward_pass.count);
    others = backward * (mis.merging + connects(path) * mis.vcm + pair.pdf_reverse * mis.vc);
#endif
    Spectrum contribution = path.throughput * pair.value *
                            (adjoint_correction(s, -path.direction, r.direction) / frame * importance * forward_pass.path_flux);
    ShadowRay shadow = shadow_ray(p, s, r.direction, r.distance, contribution, others);
    uvec2 size = uvec2(forward_pass.width, forward_pass.height);
    uvec2 pixel = min(uvec2(r.film * vec2(size)), size - 1u);
    shadow.pixel = pixel.y * size.x + pixel.x;
    return shadow;
}

// Returns whether the path goes on; the shadow ray is to be traced in either case.
bool scatter_forward_path(inout Path path, Hit hit, uint path_index, inout Counters counters, out ShadowRay shadow) {
    shadow = no_shadow_ray();
    float carried = luminance(path.throughput);
#if HAS_BENDING
    Spectrum before = path.throughput;
#endif
    bool scatters = cross_medium(path, hit);
#if HAS_BENDING
    if (is_bent(path) && hit.primitive == NO_RECORD) {
        counters.absorbed += carried - luminance(path.throughput);
        end_step(path);
        return count_step(path, counters);
    }
#endif
    if (!scatters && hit.primitive == NO_RECORD) {
        float left = luminance(path.throughput);
        counters.absorbed += carried - left;
        counters.escaped += left;
        return false;
    }
    SurfacePoint p;
    ScatteringPoint s;
#if HAS_PRIORITIES
    Crossing crossing = Crossing(path.bodies, path.bodies, true);
#endif
#if HAS_SCATTERING
    if (scatters) {
        p = volume_point(path.origin + hit.t * path.direction, path.direction);
        s = volume_scattering_point(p.position, path.direction, path.medium, true);
    } else
#endif
    {
        p = locate(hit, path.origin, path.direction);
#if HAS_PRIORITIES
        crossing = meet_faces(path.origin, path.direction, path.bodies, hit, p);
#endif
#if HAS_BENDING
        if (is_bent(path) && !end_step_at(path, p, hit.t)) {
            path.throughput = before;
            return count_step(path, counters);
        }
#endif
#if HAS_PRIORITIES
        if (!crossing.is_there) {
            pass_faces(path, p, crossing);
            counters.absorbed += carried - luminance(path.throughput);
            return true;
        }
        s = shaded_point(p, path.direction, medium_above(crossing, p, path.direction), true);
#else
        s = shaded_point(p, path.direction, path.medium, true);
#endif
    }
#if HAS_PRIORITIES
    set_bodies(s, crossing, path.direction);
#endif
    float flat_part = flat_probability(s, -path.direction);
    if (flat_part > 0.0 && (flat_part >= 1.0 || sample_1d(path.random) < flat_part)) flatten(s, path.direction);
#if HAS_DISPERSION
    if (s.disperses) make_monochrome(path);
#endif
    bool is_delta = is_delta_point(s);
    VertexMis mis = vertex_mis(path, p, s);
#if CONNECT_VERTICES || MERGE_VERTICES
    if (!is_delta) store_vertex(path, path_index, p, s, hit, mis);
#endif
    // connect_receiver, scatter_surfaces
    ReceiverSample r = ReceiverSample(vec3(0, 0, 1), 0.0, vec2(0), 0.0, 0.0);
    if (!is_delta) r = receiver_connect(forward_pass.receiver, p.position, sample_2d(path.random), film_aspect());
    vec3 wi = r.direction * s.frame;
    SurfaceEvent event = scattering_event(s, wi, wi, 1u, sample_3d(path.random));
    if (r.pdf > 0.0 && is_on_one_side(s, r.direction, wi))
        shadow = connect_receiver(path, p, s, r, event.pair, mis);
    if (!follow_sample(path, p, s, event, mis)) {
        counters.absorbed += carried;
        return false;
    }
    counters.absorbed += carried - luminance(path.throughput);
    return continue_path(path, event.next.event, counters);
}
