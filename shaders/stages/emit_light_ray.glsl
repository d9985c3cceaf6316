// Starts a forward path: a light chosen by its power, a ray that it sends. Throughput 0 where there is none.
#include "features/bending.glsl"
#include "features/dispersion.glsl"
#include "features/light_layers.glsl"
#include "features/mis.glsl"
#include "features/polarization.glsl"
#include "features/recording.glsl"
#include "features/start_media.glsl"
#include "features/surface_exitance.glsl"
#include "interfaces/light_source.glsl"
#include "lib/forward_pass.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

Path emit_light_ray(uint index) {
    Path path;
    path.random = start_forward_sampler(forward_pass.pass, index, forward_pass.count, forward_pass.seed);
    float probability;
    uint light = choose_emitter(sample_1d(path.random), probability);
    vec2 u_position = sample_2d(path.random), u_direction = sample_2d(path.random);
    EmittedRay ray = light_emit(lights[light], scene_bounds(), u_position, u_direction);
    float density = ray.pdf * probability;
    path.origin = offset_origin(ray.origin, ray.error, ray.normal, ray.direction);
    path.direction = ray.direction;
    start_location(path, location_of_light(light));
    path.throughput = density > 0.0 ? ray.radiance * (forward_pass.inverse_power / density) : Spectrum(0);
    path.reference = ray.origin;
    path.pdf = 0.0;
    path.around = around_light(light, ray.front);
    path.depth = 0u;
    path.flags = PATH_STARTS;
    path.vertices = uvec2(NO_RECORD, 0u);
    start_hero(path, sample_seed(path.random));
    start_stokes(path, light, u_position, u_direction);
    leave_light(path, light);
    start_mode(path);
    start_bending(path);
    start_passage(path);
    start_forward_weights(path, density, ray.is_delta, light, ray.normal);
    leave_emitter(path, light, ray.front);
    record_light(light);
    return path;
}
