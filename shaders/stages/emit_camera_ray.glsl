// Starts a backward path: a point of the pixel (box filter), the receiver's ray through it.
#include "features/bending.glsl"
#include "features/bias.glsl"
#include "features/dispersion.glsl"
#include "features/polarization.glsl"
#include "features/start_media.glsl"
#include "features/weights.glsl"
#include "interfaces/receiver.glsl"
#include "lib/forward_pass.glsl"
#include "lib/path.glsl"

Path emit_camera_ray(uint receiver, uvec2 pixel, uvec2 size, uint sample_index, uint seed) {
    Path path;
    path.random = start_sampler(pixel, sample_index, seed);
    vec2 film = (vec2(pixel) + sample_2d(path.random)) / vec2(size);
    vec2 u = vec2(0.5);
    if (HAS_APERTURES == 1) u = sample_2d(path.random);
    CameraRay ray = receiver_emit(receiver, film, u, float(size.x) / float(size.y));
    path.origin = ray.origin;
    path.direction = ray.direction;
    path.throughput = Spectrum(ray.weight);
    path.radiance = Received(0);
    path.reference = ray.origin;
    path.pdf = 0.0;
    path.around = around_receiver();
    path.depth = 0u;
    path.flags = PATH_STARTS | (ray.is_parallel ? PATH_PARALLEL : 0u);
    if (HAS_RECEPTORS == 1 && ray.at_receptor) path.flags |= PATH_TO_RECEPTOR;
    start_hero(path, path.random.pixel_hash >> 8);
    start_rows(path, receiver);
    start_mode(path);
    start_bending(path);
    start_passage(path);
    start_weights(path, float(forward_pass.count) * ray.connect_pdf / (ray.density * float(size.x) * float(size.y)), 0.0);
    start_bias(path);
    return path;
}
