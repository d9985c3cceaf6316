// Starts a backward path: a point of the pixel (box filter), the receiver's ray through it. `place`: of the pixel in the view.
#include "features/bending.glsl"
#include "features/bias.glsl"
#include "features/dispersion.glsl"
#include "features/light_layers.glsl"
#include "features/polarization.glsl"
#include "features/start_media.glsl"
#include "features/surface_meters.glsl"
#include "features/weights.glsl"
#include "features/views.glsl"
#include "lib/forward_pass.glsl"
#include "lib/path.glsl"

// How many forward paths stand against each backward path of this density.
float forward_share(View view, CameraRay ray) { return view.share * float(forward_pass.count) / (ray.density * pixel_count(view)); }

Path emit_camera_ray(View view, uint place, uint sample_index, uint seed) {
    uvec2 pixel = uvec2(place % view.width, place / view.width);
    Path path;
    path.random = start_sampler(pixel, sample_index, seed);
    vec2 film = (vec2(pixel) + within_pixel(view, sample_2d(path.random))) / vec2(view.width, view.height);
    vec2 u = vec2(0.5);
    if (HAS_APERTURES == 1) u = sample_2d(path.random);
    CameraRay ray = receiver_emit(view.receiver, film, u, film_aspect(view));
    path.origin = ray.origin;
    path.direction = ray.direction;
    start_location(path, view.element);
    path.throughput = Spectrum(ray.weight);
    path.radiance = nothing_collected();
    path.reference = ray.origin;
    path.pdf = 0.0;
    path.around = around_ray(view, film);
    path.depth = 0u;
    path.flags = PATH_STARTS | (ray.is_parallel ? PATH_PARALLEL : 0u);
    if (HAS_RECEPTORS == 1 && ray.at_receptor) path.flags |= PATH_TO_RECEPTOR | (ray.shape << PATH_SHAPE_SHIFT) | (view.index << PATH_VIEW_SHIFT);
    start_hero(path, path.random.pixel_hash >> 8);
    start_rows(path, view.receiver);
    start_history(path);
    start_mode(path);
    start_bending(path);
    start_passage(path);
    bool is_met = is_far(view.receiver) || starts_at_surface(view, ray);  // by light on its way
    start_weights(path, forward_share(view, ray) * ray.connect_pdf, is_met ? forward_share(view, ray) : 0.0);
    if (FORWARD_ONLY == 1 && is_met) path.throughput = Spectrum(0);  // light gets there by itself
    start_bias(path);
    return path;
}
