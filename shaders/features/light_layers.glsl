// Layers that hold only light that has come a certain way: from one lamp, reflected by one mirror, scattered once. Paths of both
// directions carry a history: what has befallen their light so far. Where they meet the histories are joined, and the whole
// tells the layer, the first whose test it passes, else the last.
//
// A history has a field of bits for each kind of event that some layer asks for, at the objects that it names: n of them have set
// the lowest n bits, as many as the field has. So a test is of bits that must be set and bits that must not
// (host/render/light_layers.h). An event is a history, too: the lowest bits of the fields that count it.
#include "features/film_layers.glsl"
#include "lib/light_vertices.glsl"
#include "lib/path.glsl"
#include "lib/scattering.glsl"

#if LIGHT_LAYERS > 0
const uint LOWEST_BITS = uint(HISTORY_LOWEST_BITS);  // of all fields
const int HISTORY_FIELD_BITS = int(HISTORY_BITS);    // that the largest one has

layout(scalar, set = 0) readonly buffer LayerTests { uvec2 layer_tests[]; };     // must be set, must not
layout(scalar, set = 0) readonly buffer LayerLights { uint layer_lights[]; };    // of each light, as it leaves it
layout(scalar, set = 0) readonly buffer LayerObjects { uint layer_objects[]; };  // of each primitive, into layer_events
layout(scalar, set = 0) readonly buffer LayerEvents { uvec3 layer_events[]; };   // reflected, refracted, straight; of nothing first
layout(scalar, set = 0) readonly buffer LayerMedia { uint layer_media_stride; uint layer_media[]; };  // scattered, by RecordRef

// What has befallen light that both have befallen.
uint joined(uint a, uint b) {
    if (HISTORY_FIELD_BITS == 1) return a | b;
    for (int i = 0; i < HISTORY_FIELD_BITS; ++i) {
        uint counted = b & LOWEST_BITS, fields = counted;
        for (int k = 1; k < HISTORY_FIELD_BITS; ++k) fields |= fields << 1 & ~LOWEST_BITS;
        a |= counted | (a << 1 & fields & ~LOWEST_BITS);
        b = b >> 1 & ~(LOWEST_BITS >> 1);
    }
    return a;
}

uint layer_of_history(uint history) {
    uint layer = uint(LIGHT_LAYERS) - 1u;
    for (int i = LIGHT_LAYERS - 2; i >= 0; --i) {
        uvec2 test = layer_tests[i];
        if ((history & (test.x | test.y)) == test.x) layer = uint(i);
    }
    return layer;
}

// A lamp, an instance or a shape, as a hit or a forward vertex names it.
uint layer_object(uint primitive, uint instance) { return layer_objects[instance != NO_RECORD ? instance : primitive]; }

uint history_of_event(ScatteringPoint s, vec3 direction, vec3 back, bool straight) {
    if (in_volume(s)) {
        uint medium = s.sides.above.medium;
        return layer_media[record_tag(medium) * layer_media_stride + record_index(medium)];
    }
    uvec3 event = layer_events[s.object];
    if (straight) return event.z;
    return dot(direction, s.normal) * dot(back, s.normal) > 0.0 ? event.x : event.y;
}

// Of a point that was met there, or at a receptor, which is no object; points within media have none either.
void keep_object(inout ScatteringPoint s, bool is_receptor, uint primitive, uint instance) {
    s.object = is_receptor || in_volume(s) ? 0u : layer_object(primitive, instance);
}

void start_history(inout Path path) { path.history = 0u; }
void leave_light(inout Path path, uint light) { path.history = layer_lights[light]; }
// The path turns at s towards `direction`, or passes on.
void go_through(inout Path path, ScatteringPoint s, vec3 direction, bool straight) {
    path.history = joined(path.history, history_of_event(s, direction, -path.direction, straight));
}
void keep_history(inout LightVertex v, Path path) { v.history = path.history; }

// The same of a shadow ray that leaves the path there, passes straight on, comes to a light, or to a forward vertex from which
// light goes on to it.
void turn_history(inout ShadowRay shadow, Path path, ScatteringPoint s) {
    shadow.history = joined(path.history, history_of_event(s, shadow.direction, -path.direction, false));
}
void carry_history(inout ShadowRay shadow, Path path) { shadow.history = path.history; }
void pass_straight(inout ShadowRay shadow, uint primitive, uint instance) {
    shadow.history = joined(shadow.history, layer_events[layer_object(primitive, instance)].z);
}
void come_to_light(inout ShadowRay shadow, uint light) { shadow.history = joined(shadow.history, layer_lights[light]); }
void come_to_vertex(inout ShadowRay shadow, LightVertex y, ScatteringPoint there, vec3 light_direction) {
    uint event = history_of_event(there, -shadow.direction, light_direction, false);
    shadow.history = joined(shadow.history, joined(event, y.history));
}

Brought brought_by(ShadowRay shadow, Received light) { return Brought(light, layer_of_history(shadow.history)); }
Brought brought_from(Path path, uint light, Received seen) {
    return Brought(seen, layer_of_history(joined(path.history, layer_lights[light])));
}
// By merging at s with a forward vertex whose light comes from `light_direction`.
Brought brought_through(Path path, ScatteringPoint s, vec3 light_direction, LightVertex y, Received light) {
    uint event = history_of_event(s, light_direction, -path.direction, false);
    return Brought(light, layer_of_history(joined(joined(path.history, event), y.history)));
}

#else
#define keep_object(s, is_receptor, primitive, instance)
#define start_history(path)
#define leave_light(path, light)
#define go_through(path, s, direction, straight)
#define keep_history(v, path)
#define turn_history(shadow, path, s)
#define carry_history(shadow, path)
#define pass_straight(shadow, primitive, instance)
#define come_to_light(shadow, light)
#define come_to_vertex(shadow, y, there, light_direction)
#define brought_by(shadow, light) light
#define brought_from(path, light, seen) seen
#define brought_through(path, s, light_direction, y, light) light
#endif
