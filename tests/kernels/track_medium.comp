// Free paths along one ray through a medium of a scene, and what passes it.
#include "interfaces/medium_optics.glsl"
#include "lib/sampler.glsl"
layout(local_size_x = 64) in;

struct Track { float distance; uint scatters; vec3 weight; float passage; vec3 transmittance; float mean; };
layout(scalar, set = 0) writeonly buffer Tracks { Track tracks[]; };
layout(push_constant) uniform Push {
    uint count, seed, medium;
    float x, y, z, dx, dy, dz, distance, carried_r, carried_g, carried_b;
};

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    MediumRay ray = MediumRay(vec3(x, y, z), vec3(dx, dy, dz), distance, 0u);
    uvec3 random = hash_3d(hash_3d(uvec3(i, seed, 1u)));
    FreePath f = medium_free_path(medium, ray, vec3(carried_r, carried_g, carried_b), vec2(random.xy >> 8) / 16777216.0, random.z);
    Passage p = medium_pass(medium, ray, hash_3d(uvec3(i, seed, 2u)).x);
    tracks[i] = Track(f.distance, f.scatters ? 1u : 0u, f.weight, f.passage, p.transmittance, p.mean);
}
