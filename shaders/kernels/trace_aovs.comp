// What each pixel sees first: albedo (directional, estimated by sampling the surface), shading normal in world space,
// depth. Means over primary rays; a ray that meets nothing counts as zero, and not at all for depth.
// Reads: scene. Writes: aovs. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint receiver;
    uint width;
    uint height;
    uint sample_count;
    uint seed;
};

#include "lib/scattering.glsl"
#include "lib/traversal.glsl"
#include "stages/emit_camera_ray.glsl"

struct Aov {
    vec3 albedo;
    vec3 normal;
    float depth;  // m along the ray; 0 = nothing seen
};
layout(scalar, set = 0) buffer Aovs { Aov aovs[]; };

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= width * height) return;
    Aov sum = Aov(vec3(0), vec3(0), 0.0);
    float hits = 0.0;
    for (uint i = 0u; i < sample_count; ++i) {
        Path path = emit_camera_ray(receiver, uvec2(pixel % width, pixel / width), uvec2(width, height), i, seed);
        Hit hit = find_hit(path.origin, path.direction, INFINITY);
        if (hit.primitive == NO_RECORD) continue;
        SurfacePoint p = locate(hit, path.origin, path.direction);
        ScatteringPoint s = scattering_point(p, path.direction, path.medium, false);
        BsdfSample b = surface_sample(s.surface, s.context, s.wo, sample_3d(path.random));
        sum.albedo += b.weight;
        sum.normal += s.frame[2];
        sum.depth += hit.t;
        hits += 1.0;
    }
    aovs[pixel] = Aov(sum.albedo / float(sample_count), sum.normal / float(sample_count), hits > 0.0 ? sum.depth / hits : 0.0);
}
