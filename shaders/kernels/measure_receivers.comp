// Where the pixels of a receiver that measures stand, or look, and what share of it they are. One lane a pixel. Reads: receivers.
// Writes: PixelPlaces. Barrier expected: after the dispatch.
#include "features/receiver_kinds.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint first, last, columns, rows;
    uint receiver;
};

// Mirrors struct PixelPlace of host/measure/readings.h.
struct PixelPlace {
    vec3 position, direction;
    float extent;
};
layout(scalar, set = 0) writeonly buffer PixelPlaces { PixelPlace pixel_places[]; };

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= last) return;
    // Of a triangle, where that is what a pixel is of, its centre of gravity.
    vec2 middle = on_surface(receiver) ? unwarp_triangle(vec2(1.0 / 3.0)) : vec2(0.5);
    vec2 film = (vec2(i % columns, i / columns) + middle) / vec2(columns, rows);
    CameraRay r = receiver_emit(receiver, film, vec2(0.5), float(columns) / float(rows));
    float share = 1.0 / (r.density * (r.at_receptor ? 1.0 : r.weight) * float(columns) * float(rows));  // m² or sr
    if (r.shape != 0u) share = 0.0;  // what small bodies receive is no flux through their plane
    pixel_places[i - first] = PixelPlace(r.origin, -r.direction, share);
}
