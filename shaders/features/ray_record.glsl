// Rays written down where they cross a receiver that records them (receivers/rays.glsl): what forward paths carry there, whatever other
// ways bring the same light to its picture. Of all crossings those with the least keys are kept, so that they are an even sample
// whose size the host chooses (host/render/ray_record.h).
#include "features/receiver_kinds.glsl"
#include "features/views.glsl"
#include "lib/forward_pass.glsl"
#include "lib/path.glsl"

#if RECORD_RAYS && FORWARD
// Twin: struct DeviceCrossing of host/render/ray_record.cpp.
struct RayCrossing {
    vec3 position;
    uint view;
    vec3 direction;
    uint key;    // evenly distributed
    vec4 flux;   // lanes of radiance times étendue; as luminance lm
};
layout(scalar, set = 0) buffer Crossings {
    uint crossing_count;  // that there were; what has no room is missing
    uint crossing_room;
    uint greatest_key;
    uint crossing_padding;
    RayCrossing crossings[];
};

void record_crossing(Path path, vec3 position, View view) {
    if (!records_rays(view.receiver)) return;
    uint key = hash_3d(uvec3(sample_seed(path.random), path.depth, floatBitsToUint(path.direction.x))).x;
    if (key > greatest_key) return;
    uint place = atomicAdd(crossing_count, 1u);
    if (place >= crossing_room) return;
    vec4 flux = vec4(0);
    for (uint i = 0u; i < LANES; ++i) flux[i] = path.throughput[i] * forward_pass.path_flux;
    crossings[place] = RayCrossing(position, view.index, path.direction, key, flux);
}
#else
#define record_crossing(path, position, view)
#endif
