// One event of a forward path: what the ray meets is crossed, connected to the receiver, stored, and scattered from.
#include "features/far_receivers.glsl"
#include "features/meeting.glsl"
#include "features/power_ledger.glsl"
#include "features/ray_record.glsl"
#include "features/surface_exitance.glsl"
#include "lib/events.glsl"
#include "stages/arrive.glsl"

// The ray that brings light from the point to the receiver of a view.
ShadowRay connect_receiver(Path path, SurfacePoint p, ScatteringPoint s, View view, ReceiverSample r, Scattering pair,
                           VertexMis mis) {
    float frame = frame_probability(s, -path.direction, r.direction);
    if (is_black(pair.value) || !is_seen_from(s, r.direction) || !(frame > 0.0)) return no_shadow_ray();
    float importance = r.density * pixel_count(view) / (r.pdf * view.share);  // of one pixel
    float others = others_of_receiver_sample(path, s, r.direction, importance, pair, mis);
    if (is_far(view.receiver)) others += pair.pdf * frame / r.pdf;  // the light escapes that way
    Spectrum contribution = path.throughput * pair.value * (adjoint_correction(s, -path.direction, r.direction) / frame *
                                                            importance * r.weight * forward_pass.path_flux);
    ShadowRay shadow = shadow_ray(path, p, s, pair, r.direction, r.distance, contribution, others);
    shadow.target = pixel_of(view, r.film);
    return shadow;
}

// The event itself. Returns whether the path goes on.
bool scatter_forward(inout Path path, Arrival a, Hit hit, uint path_index, out uint kind, out ShadowRay shadow) {
    shadow = no_shadow_ray();
    SurfacePoint p = a.p;
    ScatteringPoint s = scattering_at(path, a);
    keep_object(s, a.caught, hit.primitive, hit.instance);
    float flat_part = flat_probability(s, -path.direction);
    if (flat_part > 0.0 && (flat_part >= 1.0 || sample_1d(path.random) < flat_part)) flatten(s, path.direction);
    part_at_interface(path, s.disperses);
    bool is_delta = is_delta_point(s);
    VertexMis mis = vertex_mis(path, p, s);
    if (a.caught) mis.merging = 0.0;
    if (!is_delta && !a.caught && !within_element(path)) store_vertex(path, path_index, p, s, hit, mis);
    // connect_receiver, scatter_surfaces
    ReceiverSample r = no_receiver_sample();
    uint v = NO_RECORD;
    if (!is_delta) v = a.caught ? catching_view(path, hit) : choose_view(path.random);
    View view = views[v == NO_RECORD ? 0u : v];
    if (a.caught) record_crossing(path, p.position, view);
    if (v != NO_RECORD && same_element(path, view)) r = receiver_connect(view.receiver, p.position, sample_2d(path.random), film_aspect(view));
    if (HAS_SURFACE_METERS == 1)
        if (a.caught && hit.primitive != NO_RECORD) r = caught_at_surface(path, view, hit);
    vec3 wi = r.direction * s.frame;
    SurfaceEvent event = scattering_event(s, wi, wi, 1u, sample_3d(path.random));
    if (r.pdf > 0.0 && is_on_one_side(s, r.direction, wi))
        shadow = connect_receiver(path, p, s, view, r, event.pair, mis);
    RETURN_IF_CAUGHT(a, path, hit, shadow)
    kind = event.next.event;
    if (!follow_sample(path, p, s, event, mis)) return false;
    if (!a.scatters && hit.instance == NO_RECORD) leave_primitive(path, hit.primitive, dot(path.direction, p.geometric_normal) > 0.0);
    return true;
}

// Returns whether the path goes on; the shadow ray is to be traced in either case.
bool scatter_forward_path(inout Path path, Hit hit, uint path_index, inout Counters counters, out ShadowRay shadow) {
    shadow = no_shadow_ray();
    follow_hero(path);
    if (leave_surface(path, shadow)) return true;
    float carried = luminance(path.throughput);
    Spectrum before = path.throughput;
    OPEN_LEDGER(entry, path)
    bool scatters = cross_medium(path, hit);
    Arrival a = arrive(path, before, hit, scatters, counters);
    charge_crossing(entry, path);
    charge_medium(entry, luminance(path.throughput));
    bool is_event = a.is_event && !a.escapes, goes_on = a.lives;
    uint kind = EVENT_NONE;
    if (is_event) goes_on = scatter_forward(path, a, hit, path_index, kind, shadow);
    // What is left of the light; what escapes or is cut here is counted as such.
    float left = is_event && !goes_on ? 0.0 : luminance(path.throughput);
    counters.absorbed += carried - left;
    charge_event(entry, a.p.material, left);
    if (a.is_event && a.escapes) {
        counters.escaped += left;
        reach_far(path, shadow);
        return false;
    }
    return is_event && goes_on && !a.caught ? continue_path(path, kind, counters) : goes_on;
}
