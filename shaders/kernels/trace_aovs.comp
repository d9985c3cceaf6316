// What each pixel sees first: albedo (directional, estimated by sampling the surface), shading normal in world space,
// depth. Means over primary rays; a ray that meets nothing counts as zero, and not at all for depth.
// Reads: scene. Writes: aovs. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint receiver;
    uint first_pixel, pixel_count;  // of this dispatch
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
    float depth;  // m along the ray, also where it is bent; 0 = nothing seen
};
layout(scalar, set = 0) buffer Aovs { Aov aovs[]; };

// What the path's ray meets first, and the metres of the steps before, where it is bent.
Hit find_first(inout Path path, out float bent) {
    bent = 0.0;
    float end = begin_ray(path);
    Hit hit = find_hit(path.origin, path.direction, end);
#if HAS_BENDING
    for (uint k = 0u; k < MAX_STEPS && is_bent(path) && hit.primitive == NO_RECORD; ++k) {
        bent += path.bend.chord;
        end_step(path);
        end = begin_ray(path);
        hit = find_hit(path.origin, path.direction, end);
    }
#endif
    return hit;
}

void turn_at(inout Path path, SurfacePoint p, Hit hit) {
#if HAS_BENDING
    if (is_bent(path)) end_step_at(path, p, hit.t);
#endif
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= pixel_count) return;
    uint pixel = first_pixel + i;
    Aov sum = Aov(vec3(0), vec3(0), 0.0);
    float hits = 0.0;
    for (uint s = 0u; s < sample_count; ++s) {
        Path path = emit_camera_ray(receiver, uvec2(pixel % width, pixel / width), uvec2(width, height), s, seed);
        float bent;
        Hit hit = find_first(path, bent);
#if HAS_PRIORITIES
        float passed = 0.0;  // m, by faces that are not there
        SurfacePoint p;
        Crossing crossing;
        for (; hit.primitive != NO_RECORD; hit = find_first(path, bent)) {
            p = locate(hit, path.origin, path.direction);
            crossing = meet_faces(path.origin, path.direction, path.bodies, hit, p);
            if (crossing.is_there) break;
            passed += hit.t + bent;
            path.origin = origin_behind(path.origin, p.position, p.error, p.geometric_normal, path.direction);
            path.bodies = crossing.after;
        }
        if (hit.primitive == NO_RECORD) continue;
        hit.t += passed;
        turn_at(path, p, hit);
        ScatteringPoint point = scattering_point(p, path.direction, medium_above(crossing, p, path.direction));
#else
        if (hit.primitive == NO_RECORD) continue;
        SurfacePoint p = locate(hit, path.origin, path.direction);
        turn_at(path, p, hit);
        ScatteringPoint point = scattering_point(p, path.direction, path.medium);
#endif
        BsdfSample b = surface_sample(point.surface, point.context, point.wo, sample_3d(path.random));
        sum.albedo += spectrum_rgb(b.weight);
        sum.normal += point.frame[2];
        sum.depth += hit.t + bent;
        hits += 1.0;
    }
    aovs[i] = Aov(sum.albedo / float(sample_count), sum.normal / float(sample_count), hits > 0.0 ? sum.depth / hits : 0.0);
}
