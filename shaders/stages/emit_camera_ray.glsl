// Starts a backward path: a point of the pixel (box filter), the receiver's ray through it.
#include "interfaces/receiver.glsl"
#include "lib/path.glsl"

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
    path.medium = NO_RECORD;
    path.depth = 0u;
    return path;
}
