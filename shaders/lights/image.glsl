// An image wrapped around the scene, infinitely far away, in latitude and longitude. The centre of the image
// looks along -z, columns run to the right as seen from inside (at 3/4 of the width: +x), the top row is up
// (+y). Between the centres of its texels it is bilinear, and directions are sampled exactly in proportion to luminance
// (lib/environment_map.glsl).
//
// Example:
//     {"extensions": {"ETD_optics": {
//         "environment": {"class": "image", "file": "sky.hdr", "rotation": -1}}}}

#include "lib/environment_map.glsl"

struct ImageEnvironment {
    EnvironmentMapRef file;  //: required. Latitude-longitude image, .hdr or .exr, linear.
    float scale;             //: 1 in [0, inf). Multiplies the image.
    float rotation;          //: 0 rad. Turns the image about +y, counter-clockwise seen from above.
};

// Radiance of the image itself, before `scale`.
vec3 image_texels(ImageEnvironment r, vec3 direction) { return environment_radiance(r.file, r.rotation, direction); }

LightSample image_sample_towards(ImageEnvironment r, vec3 point, vec2 u) {
    if (!(r.file.integral > 0.0)) return no_light_sample();
    EnvironmentSample s = environment_sample(r.file, r.rotation, u);
    float pdf = luminance(s.radiance) / r.file.integral;
    return LightSample(s.direction, INFINITY, radiance_of_rgb(s.radiance * r.scale), pdf,
                       pdf * outer_disk_pdf(scene_bounds()), false);
}

Spectrum image_radiance(ImageEnvironment r, vec3 direction, LightHit hit) {
    return radiance_of_rgb(image_texels(r, direction) * r.scale);
}

float image_pdf_towards(ImageEnvironment r, vec3 point, vec3 direction, LightHit hit) {
    return r.file.integral > 0.0 ? luminance(image_texels(r, direction)) / r.file.integral : 0.0;
}

EmittedRay image_emit(ImageEnvironment r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    LightSample l = image_sample_towards(r, vec3(0), u_direction);
    return EmittedRay(outer_disk_point(bounds, -l.direction, u_position), vec3(0), -l.direction, -l.direction, l.radiance,
                      l.pdf * outer_disk_pdf(bounds), false, true);
}

float image_pdf_emit(ImageEnvironment r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return image_pdf_towards(r, vec3(0), direction, hit) * outer_disk_pdf(bounds);
}

float image_power(ImageEnvironment r, SceneBounds bounds) {
    return PI * square(bounds.radius) * r.file.integral * r.scale;
}

void image_bounds(ImageEnvironment r, out vec3 lo, out vec3 hi) { lo = vec3(1), hi = vec3(-1); }

LightCone image_cone(ImageEnvironment r) { return whole_sphere_cone(); }
