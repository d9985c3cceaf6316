// Starts a forward path in every slot, and queues those that carry something.
// Reads: lights. Writes: paths, the ray queue of bounce 0 and its count, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint paths, first_path; };
#include "features/meeting.glsl"
#include "lib/counters.glsl"
#include "lib/wavefront.glsl"
#include "stages/emit_light_ray.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    Counters counters = no_counters();
    bool alive = false;
    if (slot < paths) {
        Path path = emit_light_ray(first_path + slot);
        counters.emitted += luminance(path.throughput);
        alive = !is_black(path.throughput);
        if (alive) store_path(slot, path);
        else end_forward_path(first_path + slot, path);
    }
    uint place = append(0u, alive);
    if (alive) ray_queue[place] = slot;
    store_counters(counters);
}
