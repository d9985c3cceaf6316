// Whole forward paths in one kernel, as trace_paths does it for backward ones.
// Reads: scene. Writes: splats, forward vertices, counters. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;

#include "features/meeting.glsl"
#include "features/splats.glsl"
#include "lib/counters.glsl"
#include "stages/emit_light_ray.glsl"
#include "stages/scatter_forward_path.glsl"
#include "stages/trace_shadow.glsl"

void main() {
    uint lanes = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint index = scattered_lane();
    Counters counters = no_counters();
    Path path;
    bool alive = false;
    while (index < forward_pass.count) {
        if (!alive) {
            path = emit_light_ray(index);
            counters.emitted += luminance(path.throughput);
            alive = !is_black(path.throughput);
        }
        if (alive) {
            counters.rays++;
            float end = begin_ray(path);
            locate_ray(path.location);
            Hit hit = find_hit(path.origin, path.direction, end);
            ShadowRay shadow;
            alive = scatter_forward_path(path, hit, index, counters, shadow);
            Brought brought = trace_shadow(shadow, counters);
            if (!is_black(brought) && !add_splat(shadow.target, brought)) counters.non_finite++;
        }
        if (!alive) {
            end_forward_path(index, path);
            index += lanes;
        }
    }
    if (index < forward_pass.count) cut_path(path, counters);  // as in trace_paths
    store_counters(counters);
}
