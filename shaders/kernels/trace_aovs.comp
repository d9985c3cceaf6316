// What each pixel sees first: albedo (directional, estimated by sampling the surface), shading normal in world space,
// depth. Means over primary rays; a ray that meets nothing counts as zero, and not at all for depth.
// Reads: scene. Writes: aovs. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint first_pixel, pixels;  // of this dispatch, among those of all views
    uint sample_count;
    uint seed;
};

#include "stages/emit_camera_ray.glsl"
#include "stages/find_first.glsl"

struct Aov {
    vec3 albedo;
    vec3 normal;
    float depth;  // m along the ray, also where it is bent; 0 = nothing seen
};
layout(scalar, set = 0) buffer Aovs { Aov aovs[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= pixels) return;
    uint pixel = first_pixel + i;
    View view = view_of(pixel);
    Aov sum = Aov(vec3(0), vec3(0), 0.0);
    float hits = 0.0;
    for (uint s = 0u; s < sample_count; ++s) {
        Path path = emit_camera_ray(view, pixel - view.first_pixel, s, seed);
        FirstHit first = find_first(path);
        if (!first.found) continue;
        ScatteringPoint point = scattering_point(first.p, path.direction, first.sides);
        BsdfSample b = surface_sample(point.surface, point.context, point.wo, sample_3d(path.random));
        sum.albedo += spectrum_rgb(b.weight);
        sum.normal += point.frame[2];
        sum.depth += first.distance;
        hits += 1.0;
    }
    aovs[i] = Aov(sum.albedo / float(sample_count), sum.normal / float(sample_count), hits > 0.0 ? sum.depth / hits : 0.0);
}
