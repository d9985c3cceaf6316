// Paths written down event by event, to be looked at: a lane a path, by the stages and random numbers of the renderer, so that
// backward path `i` of a pass is that of pixel i, and forward path `i` the i-th. Nothing is connected or merged.
// Reads: scene, path indices. Writes: path vertices, their number. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint count;  // of the paths
    uint room;   // for vertices of a path; what is longer is cut
    uint pass, seed;  // of backward paths
};

#define RECORD_PATHS
#if FORWARD
#include "stages/emit_light_ray.glsl"
#include "stages/scatter_forward_path.glsl"
#else
#include "stages/emit_camera_ray.glsl"
#include "stages/scatter_path.glsl"
#endif

// Twins of the bits and of struct DeviceVertex in host/render/path_record.cpp; below them are those of EVENT_….
const uint RECORDED_EMISSION = 16u;
const uint RECORDED_ESCAPE = 32u;
const uint RECORDED_ROULETTE = 64u;  // the event was the last one by Russian roulette or the depth limit
const uint RECORDED_BEND = 128u;     // a point of a bent ray
const uint RECORDED_ENTER = 1024u;    // an optical element
const uint RECORDED_LEAVE = 2048u;    // … again
struct DeviceVertex {
    vec3 position;
    uint event;
    uint material, light, medium;  // medium: that the ray arrives in
    uint primitive;                // of the world, that was hit
    uint element;                  // where it is, or that is entered or left; 0 = the scene
    float arriving, leaving;       // luminance of what the path carries
    vec3 rgb;                      // … its colour behind the event
    vec4 throughput;               // … lane by lane
    vec3 stokes, axis;             // … its polarization
};
layout(scalar, set = 0) readonly buffer PathIndices { uint path_indices[]; };
layout(scalar, set = 0) writeonly buffer PathVertices { DeviceVertex path_vertices[]; };
layout(scalar, set = 0) writeonly buffer PathCounts { uint path_counts[]; };

const float BEND_ANGLE = 0.05;  // rad, between the directions of a bent ray at two of its points: lines stay within 1/160 of
                                // their length of it

vec4 all_lanes(Spectrum s) {
    vec4 lanes = vec4(0);
    for (uint i = 0u; i < LANES; ++i) lanes[i] = s[i];
    return lanes;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
#if FORWARD
    Path path = emit_light_ray(path_indices[i]);
    uint light = recorded_light;
#else
    uint pixel = path_indices[i];
    Path path = emit_camera_ray(views[0], pixel, pass, seed);
    uint light = NO_RECORD;
#endif
    float carried = luminance(path.throughput);
    vec3 stokes, axis;
    recorded_polarization(path, stokes, axis);
    path_vertices[i * room] =
        DeviceVertex(in_scene(element_of(path), path.origin, 1.0), RECORDED_EMISSION, NO_RECORD, light, path.around.medium,
                     NO_RECORD, element_of(path), carried, carried,
                     spectrum_rgb(path.throughput), all_lanes(path.throughput), stokes,
                     in_scene(element_of(path), axis, 0.0));
    path_counts[i] = 1u;
    Counters counters;
    bool alive = !is_black(path.throughput);
    vec3 drawn = in_scene(element_of(path), path.direction, 0.0);  // of the line behind the last vertex
    for (uint n = 1u; alive && n < room;) {
        DeviceVertex v;
        v.medium = path.around.medium;
        float end = begin_ray(path);
        vec3 origin = path.origin, direction = path.direction;
        uint element = element_of(path);
        recorded_event.happened = recorded_event.followed = false;
        bool bends = is_bent(path);
        locate_ray(path.location);
        Hit hit = find_hit(origin, direction, end);
        ShadowRay shadow, vertex_shadow;
#if FORWARD
        alive = scatter_forward_path(path, hit, path_indices[i], counters, shadow);
#else
        alive = scatter_path(path, hit, counters, shadow, vertex_shadow);
#endif
        // Where a bent ray ends a step, having turned so far that a line would no longer do.
        vec3 turned = in_scene(element_of(path), path.direction, 0.0);
        bool is_bend = bends && hit.primitive == NO_RECORD && dot(turned, drawn) < cos(BEND_ANGLE);
        bool crosses = element_of(path) != element, enters = crosses && parent_of(element_of(path)) == element;
        if (alive && !recorded_event.happened && !is_bend && !crosses) continue;  // past faces that are not there, or along a bent ray
        bool escapes = !recorded_event.happened && !is_bend && !crosses, ends = recorded_event.happened && !recorded_event.followed;
        v.position = escapes ? origin + SCENE_RADIUS * direction : is_bend || crosses ? path.origin : recorded_event.position;
        v.position = in_scene(crosses ? element_of(path) : element, v.position, 1.0);
        v.element = enters ? element_of(path) : element;
        v.event = crosses ? (enters ? RECORDED_ENTER : RECORDED_LEAVE) : escapes ? RECORDED_ESCAPE : is_bend ? RECORDED_BEND : ends ? EVENT_NONE : recorded_event.event;
        if (!escapes && !ends && !alive) v.event |= RECORDED_ROULETTE;
        v.material = recorded_event.happened ? recorded_event.material : NO_RECORD;
        v.light = recorded_event.happened ? recorded_event.light : NO_RECORD;
        v.primitive = hit.instance != NO_RECORD ? hit.instance : hit.primitive;
        if (v.material == NO_RECORD) v.primitive = NO_RECORD;
        if (ends) path.throughput = Spectrum(0);
        v.leaving = luminance(path.throughput);
        v.arriving = recorded_event.happened ? recorded_event.arriving : v.leaving;
        v.rgb = spectrum_rgb(path.throughput);
        v.throughput = all_lanes(path.throughput);
        recorded_polarization(path, v.stokes, v.axis);
        v.axis = in_scene(element_of(path), v.axis, 0.0);
        path_vertices[i * room + n] = v;
        path_counts[i] = ++n;
        drawn = turned;
    }
}
