// Whole backward paths in one kernel: for scenes of few classes, where keeping a path in registers costs less than its
// traffic between kernels. Every lane works through its pixels in turn and starts the next path in the same iteration in
// which one ends, so that lanes stay full.
// Reads: scene. Writes: samples, counters of its lane. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint pixels;         // of all views
    uint first_pixel, end_pixel;  // of this dispatch
    uint first_sample;   // index of the first pass
    uint sample_count;   // passes of this dispatch
    uint sample_passes;  // that there is room for
    uint seed;
};

#include "stages/emit_camera_ray.glsl"
#include "stages/record_sample.glsl"
#include "stages/scatter_path.glsl"

void main() {
    uint lanes = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint pixel = first_pixel + scattered_lane();
    uint sample_index = 0u;
    Counters counters = no_counters();
    Path path;
    bool alive = false;
    while (pixel < end_pixel) {
        if (!alive) {
            begin_pass(sample_index);
            View view = view_of(pixel);
            path = emit_camera_ray(view, pixel - view.first_pixel, first_sample + sample_index, seed);
        }
        counters.rays++;
        float end = begin_ray(path);
        locate_ray(path.location);
        Hit hit = find_hit(path.origin, path.direction, end);
        ShadowRay shadow, vertex_shadow;
        alive = scatter_path(path, hit, counters, shadow, vertex_shadow);
        trace_shadows(shadow, vertex_shadow, path.radiance, counters);
        if (!alive) {
            uint place = sample_place(pixel, pixels, first_sample + sample_index, sample_passes);
            record_sample(place, pixel, path, counters);
            if (++sample_index == sample_count) {
                pixel += lanes;
                sample_index = 0u;
            }
        }
    }
    if (pixel < end_pixel) cut_path(path, counters);  // by a driver that ends loops early (host/gpu/loop_turns.h)
    store_counters(counters);
}
