// Starts a backward path: a point of the pixel (box filter), the receiver's ray through it.
#include "interfaces/receiver.glsl"
#include "lib/bending.glsl"
#include "lib/path.glsl"
#include "lib/start_media.glsl"
#if BIDIRECTIONAL
#include "lib/forward_pass.glsl"
#endif

Path emit_camera_ray(uint receiver, uvec2 pixel, uvec2 size, uint sample_index, uint seed) {
    Path path;
    path.random = start_sampler(pixel, sample_index, seed);
    vec2 film = (vec2(pixel) + sample_2d(path.random)) / vec2(size);
    CameraRay ray = receiver_emit(receiver, film, float(size.x) / float(size.y));
    path.origin = ray.origin;
    path.direction = ray.direction;
    path.throughput = Spectrum(ray.weight);
    path.radiance = Spectrum(0);
    path.reference = ray.origin;
    path.pdf = 0.0;
    path.medium = receiver_start_medium();
#if HAS_PRIORITIES
    path.bodies = receiver_start_bodies();
#endif
    path.depth = 0u;
    start_bending(path);
#if HAS_SCATTERING
    path.passage = 1.0;
#endif
#if BIDIRECTIONAL
    path.vcm = float(forward_pass.count) * ray.connect_pdf / (ray.density * float(size.x) * float(size.y));
    path.vc = 0.0;
    path.pending = 0.0;
#endif
#if HAS_PATH_FLAGS
    path.flags = PATH_STARTS | (ray.is_parallel ? PATH_PARALLEL : 0u);
#endif
#if MERGE_VERTICES
    path.bias = Spectrum(0);
#endif
    return path;
}
