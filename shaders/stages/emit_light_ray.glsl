// Starts a forward path: a light chosen by its power, a ray that it sends. Throughput 0 where there is none.
#include "interfaces/light_source.glsl"
#include "lib/forward_pass.glsl"
#include "lib/light_emission.glsl"
#include "lib/light_selection.glsl"
#include "lib/primitives.glsl"
#include "lib/bending.glsl"
#include "lib/path.glsl"
#include "lib/start_media.glsl"

#ifdef RECORD_PATHS
uint recorded_light;
#endif

Path emit_light_ray(uint index) {
    Path path;
    path.random = start_forward_sampler(forward_pass.pass, index, forward_pass.count, forward_pass.seed);
    float probability;
    uint light = choose_emitter(sample_1d(path.random), probability);
    vec2 u_position = sample_2d(path.random);
    EmittedRay ray = light_emit(lights[light], scene_bounds(), u_position, sample_2d(path.random));
    float density = ray.pdf * probability;
    path.origin = offset_origin(ray.origin, ray.error, ray.normal, ray.direction);
    path.direction = ray.direction;
    path.throughput = density > 0.0 ? ray.radiance * (forward_pass.inverse_power / density) : Spectrum(0);
    path.radiance = Spectrum(0);
    path.reference = ray.origin;
    path.pdf = 0.0;
    path.medium = light_start_medium(light, ray.front);
#if HAS_PRIORITIES
    path.bodies = light_start_bodies(light, ray.front);
#endif
    path.depth = 0u;
    start_bending(path);
#if HAS_SCATTERING
    path.passage = 1.0;
#endif
#if HAS_PATH_FLAGS
    path.flags = PATH_STARTS;
#endif
#if BIDIRECTIONAL
    path.vcm = 1.0 / density;  // times the density of sampling the light, known at the first vertex
    path.vc = ray.is_delta ? 0.0 : 1.0 / density;
    path.pending = 0.0;
    path.light = light;
    path.light_normal = ray.normal;
#endif
    path.vertices = uvec2(NO_RECORD, 0u);
#ifdef RECORD_PATHS
    recorded_light = light;
#endif
    return path;
}
