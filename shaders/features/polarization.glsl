// Polarized light. A forward path carries a Stokes vector, a backward one a row that multiplies such vectors from the left: the
// first number is the path's throughput, the others stand beside it in units of that, in the frame of the light, which goes
// against backward rays. Directions, depths and Russian roulette are chosen without it, so that the densities of all ways to make
// a path stay as they are; an event takes or gives up to twice of what it does to unpolarized light. Only azimuths within media are
// chosen by it, and weights do not know that.
//
// Rows and vectors meet where paths do (Mojzík et al. 2016, "Bi-directional Polarised Light Transport").
#include "features/polarized_lights.glsl"
#include "features/stokes_images.glsl"
#include "features/views.glsl"
#include "lib/forward_pass.glsl"
#include "lib/light_vertices.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"

#if HAS_POLARIZATION

// An event: by how much the frames of the vectors or rows that come must be turned to be those of its matrix, and the same behind
// it.
struct EventFrames {
    vec2 before, after;  // double_angle()
    bool transposed;     // for rows
};
EventFrames event_frames(ScatteringPoint s, Mueller m, vec3 arriving, vec3 leaving) {
    EventFrames f;
    f.transposed = !s.context.importance;
    vec3 before = f.transposed ? -arriving : arriving, after = f.transposed ? -leaving : leaving;  // of light
    f.before = double_angle(stokes_axis(before), s.frame * (f.transposed ? m.to : m.from), before);
    f.after = double_angle(s.frame * (f.transposed ? m.from : m.to), stokes_axis(after), after);
    return f;
}
Stokes through_event(Stokes s, Mueller m, EventFrames f) {
    return turned(apply_mueller(turned(s, f.before), m, f.transposed), f.after);
}
Spectrum through_event(inout Polarization p, Mueller m, EventFrames f) {
    return split_stokes(through_event(Stokes(Spectrum(1), p.s1, p.s2, p.s3), m, f), p);
}

// Below 1, since lanes may differ.
const float MOST_PREFERENCE = 0.95;

#if STOKES_IMAGE && !FORWARD
Polarization leading(Carried c) { return Polarization(c.rows[0][1], c.rows[0][2], c.rows[0][3]); }
Spectrum through_event(inout Carried c, Mueller m, EventFrames f) {
    Spectrum factor = Spectrum(1), inverse = Spectrum(1);
    for (int i = 0; i < 4; ++i) {
        c.rows[i] = through_event(c.rows[i], m, f);
        if (i == 0) {
            factor = max(c.rows[0][0], Spectrum(0));
            inverse = mix(1.0 / factor, Spectrum(0), lessThanEqual(factor, Spectrum(1e-20)));
        }
        c.rows[i] = scaled(c.rows[i], inverse);
    }
    return factor;
}
Carried turned(Carried c, vec2 angle) {
    for (int i = 0; i < 4; ++i) c.rows[i] = turned(c.rows[i], angle);
    return c;
}
Received meet(Carried c, Polarization light) {
    Received sum;
    for (int i = 0; i < 4; ++i) sum[i] = meet(c.rows[i], light);
    sum[0] = max(sum[0], Spectrum(0));
    return sum;
}
// The rows of a receiver, in the frame of the light that comes against the ray.
void start_rows(inout Path path, uint receiver) {
    vec2 angle = double_angle(receiver_stokes_axis(receiver, path.direction), stokes_axis(-path.direction), -path.direction);
    for (int i = 0; i < 4; ++i) {
        Stokes row = Stokes(0);
        row[i] = Spectrum(1);
        path.polarization.rows[i] = turned(row, angle);
    }
}
#else
#define start_rows(path, receiver) path.polarization = unpolarized()
#define leading(polarization) polarization
#endif
#define start_stokes(path, light, u_position, u_direction) path.polarization = ray_polarization(light, path.direction, u_position, u_direction)

// A path comes to s along its direction and leaves along another.
void polarize(inout Path path, ScatteringPoint s, Mueller m, vec3 leaving) {
    path.throughput *= through_event(path.polarization, m, event_frames(s, m, path.direction, leaving));
}

// Within a medium a sampled direction has any azimuth; it becomes one that the polarization of the path prefers, in proportion to
// what the event gives of it (in the mean of the lanes), or weights would grow from event to event. Half a turn of twice the azimuth,
// a quarter turn, exchanges more for less, so that one choice is enough. Densities for weights stay those of unpolarized light.
void prefer_azimuth(inout Path path, ScatteringPoint s, inout SurfaceEvent event) {
    float across = dot(event.next.wi.xy, event.next.wi.xy);
    if (!in_volume(s) || !(across > 0.0)) return;
    // The first axis lies across the plane of both directions: along y for wi in the plane of x and z.
    vec3 light = FORWARD == 1 ? path.direction : -path.direction;
    Polarization p = turned(leading(path.polarization), double_angle(stokes_axis(light), s.frame[1], light));
    Spectrum share = path.throughput * event.next.weight;
    share /= max(dot(share, Spectrum(1)), 1e-30);
    share *= event.next_mueller.b;
    vec2 prefers = vec2(dot(share, p.s1), dot(share, FORWARD == 1 ? p.s2 : -p.s2));
    float most = length(prefers);
    if (most > MOST_PREFERENCE) prefers *= MOST_PREFERENCE / most;
    vec2 wi = event.next.wi.xy;
    float preference = dot(prefers, vec2(wi.x * wi.x - wi.y * wi.y, 2.0 * wi.x * wi.y)) / across;
    if (sample_1d(path.random) >= 0.5 + 0.5 * preference) {
        event.next.wi.xy = vec2(-wi.y, wi.x);
        preference = -preference;
    }
    event.next.weight /= 1.0 + preference;
    vec3 to = FORWARD == 1 ? event.next.wi : s.wo;
    event.next_mueller.from = event.next_mueller.to = facet_axis(to, FORWARD == 1 ? s.wo : event.next.wi);
}

// … and casts a shadow ray.
void polarize_shadow(inout ShadowRay shadow, Path path, ScatteringPoint s, Mueller m) {
    shadow.polarization = path.polarization;
    shadow.contribution *= through_event(shadow.polarization, m, event_frames(s, m, path.direction, shadow.direction));
}

// A shadow ray that carries on the path's own.
void carry_polarization(inout ShadowRay shadow, Path path) { shadow.polarization = path.polarization; }

// What a shadow ray passes straight through, at s.
void polarize_passage(inout ShadowRay shadow, ScatteringPoint s) {
    s.context.importance = FORWARD == 1;
    vec3 from = FORWARD == 1 ? s.wo : -s.wo;
    Mueller m = surface_transparency_mueller(s.surface, s.context, from);
    shadow.contribution *= through_event(shadow.polarization, m, event_frames(s, m, shadow.direction, shadow.direction));
}

// The ray turns without an event, as in media that bend it.
void turn_polarization(inout Path path, vec3 before, vec3 after) {
    vec3 a = FORWARD == 1 ? before : -before, b = FORWARD == 1 ? after : -after;
    vec3 axis = stokes_axis(a), sum = a + b;
    axis -= sum * (2.0 * dot(sum, axis) / max(dot(sum, sum), 1e-30));  // mirrored across the bisecting plane, as a is to -b
    path.polarization = turned(path.polarization, double_angle(axis, stokes_axis(b), b));
}

// The path goes on in another frame, whose axes are turned: `after` is its direction there.
void turn_frame(inout Path path, mat3 turn, vec3 after) {
    vec3 a = FORWARD == 1 ? path.direction : -path.direction, b = FORWARD == 1 ? after : -after;
    path.polarization = turned(path.polarization, double_angle(turn * stokes_axis(a), stokes_axis(b), b));
}

// What forward vertices keep: light as it arrives, in half precision (an error of 5e-4).
PackedPolarization packed_polarization(Polarization p) {
    PackedPolarization packed;
    for (uint i = 0u; i < POLARIZATION_WORDS; ++i) packed.words[i] = 0u;
    for (uint i = 0u; i < 3u * LANES; ++i) {
        float value = i < LANES ? p.s1[i] : i < 2u * LANES ? p.s2[i - LANES] : p.s3[i - 2u * LANES];
        packed.words[i / 2u] |= packHalf2x16(vec2(value, 0)) << (16u * (i & 1u));
    }
    return packed;
}
Polarization polarization_of(LightVertex v) {
    Polarization p = unpolarized();
    for (uint i = 0u; i < 3u * LANES; ++i) {
        float value = unpackHalf2x16(v.polarization.words[i / 2u] >> (16u * (i & 1u))).x;
        if (i < LANES) p.s1[i] = value;
        else if (i < 2u * LANES) p.s2[i - LANES] = value;
        else p.s3[i - 2u * LANES] = value;
    }
    return p;
}
#if FORWARD
// The direction is kept with less precision, and the frame follows it.
void keep_polarization(inout LightVertex v, Path path) {
    vec3 kept = -decode_octahedral(v.direction);
    v.polarization =
        packed_polarization(turned(path.polarization, double_angle(stokes_axis(path.direction), stokes_axis(kept), kept)));
}

#else
// What a backward path brings that merges at s with forward vertex y, and would bring this of unpolarized light.
Received merged_light(Spectrum brought, Path path, ScatteringPoint s, Mueller m, LightVertex y) {
    Carried rows = path.polarization;
    Spectrum factor = through_event(rows, m, event_frames(s, m, path.direction, decode_octahedral(y.direction)));
    return scaled(meet(rows, polarization_of(y)), brought * factor);
}
#endif

#if CONNECT_VERTICES && !FORWARD
// The light of y goes on at `there` to the end of a shadow ray, where it meets the row that has come along that.
void polarize_end(inout ShadowRay shadow, LightVertex y, ScatteringPoint there, Mueller m) {
    shadow.end = polarization_of(y);
    vec3 arriving = -decode_octahedral(y.direction);
    shadow.contribution *= through_event(shadow.end, m, event_frames(there, m, arriving, -shadow.direction));
}
#endif
#if HAS_POLARIZED_ENDS
// … to which a light sends it.
void end_at_light(inout ShadowRay shadow, uint light) { shadow.end = light_polarization(light, -shadow.direction); }
#else
#define end_at_light(shadow, light)
#endif

// What reaches the receiver of light that a backward path comes to, or a shadow ray has passed on to its end: `brought`, if it is
// not polarized.
#if (STOKES_IMAGE || HAS_POLARIZED_LIGHTS) && !FORWARD
Received seen_light(Path path, Spectrum brought, uint light) {
    return scaled(meet(path.polarization, light_polarization(light, -path.direction)), brought);
}
#else
#define seen_light(path, brought, light) brought
#endif
#if HAS_POLARIZED_ENDS
#define analysed(shadow, brought) scaled(meet(shadow.polarization, shadow.end), brought)
#elif STOKES_IMAGE && FORWARD
Received analysed(ShadowRay shadow, Spectrum brought) {
    vec3 axis = receiver_stokes_axis(view_of(shadow.target).receiver, -shadow.direction);
    Polarization p = turned(shadow.polarization, double_angle(stokes_axis(shadow.direction), axis, shadow.direction));
    return scaled(Stokes(Spectrum(1), p.s1, p.s2, p.s3), brought);
}
#elif STOKES_IMAGE
#define analysed(shadow, brought) scaled(meet(shadow.polarization, unpolarized()), brought)
#else
#define analysed(shadow, brought) brought
#endif

#else
#define start_rows(path, receiver)
#define start_stokes(path, light, u_position, u_direction)
#define polarize(path, s, mueller, leaving)
#define prefer_azimuth(path, s, event)
#define polarize_shadow(shadow, path, s, mueller)
#define carry_polarization(shadow, path)
#define polarize_passage(shadow, s)
#define turn_polarization(path, before, after)
#define turn_frame(path, turn, after)
#define keep_polarization(v, path)
#define merged_light(brought, path, s, mueller, y) brought
#define polarize_end(shadow, y, there, mueller)
#define end_at_light(shadow, light)
#define seen_light(path, brought, light) brought
#define analysed(shadow, brought) brought
#endif
