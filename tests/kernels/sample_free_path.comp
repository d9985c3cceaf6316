// Free paths through a medium that is the same everywhere.
#include "lib/free_path.glsl"
#include "lib/sampler.glsl"
layout(local_size_x = 64) in;

struct Path { float distance; uint scatters; vec3 weight; float passage; };
layout(scalar, set = 0) writeonly buffer Paths { Path paths[]; };
layout(push_constant) uniform Push {
    uint count, seed, steps;  // steps > 0: the second number runs over 0, 2^-24, … steps - 1 times that
    float extinction_r, extinction_g, extinction_b, scattering_r, scattering_g, scattering_b;
    float carried_r, carried_g, carried_b, distance;
};

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec2 u = vec2(hash_3d(hash_3d(uvec3(i, seed, 1u))).xy >> 8) / 16777216.0;
    if (steps > 0u) u.y = float(i % steps) / 16777216.0;
    FreePath f = sample_free_path(vec3(extinction_r, extinction_g, extinction_b), vec3(scattering_r, scattering_g, scattering_b),
                                  distance, vec3(carried_r, carried_g, carried_b), u);
    paths[i] = Path(f.distance, f.scatters ? 1u : 0u, f.weight, f.passage);
}
