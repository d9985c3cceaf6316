// Starts a path in every slot.
// Reads: views, receivers. Writes: paths, the ray queue of bounce 0 and its count. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint paths;
    uint first_pixel, tile_pixels, first_sample, seed;
};
#include "lib/wavefront.glsl"
#include "stages/emit_camera_ray.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot == 0u) queue_counts[0] = paths;
    if (slot >= paths) return;
    uint pixel = first_pixel + slot % tile_pixels;
    uint sample_index = first_sample + slot / tile_pixels;
    View view = view_of(pixel);
    store_path(slot, emit_camera_ray(view, pixel - view.first_pixel, sample_index, seed));
    ray_queue[slot] = slot;
}
