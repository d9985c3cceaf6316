// Counters of a kernel: summed over the subgroup, then added to one row of sums. Counts wrap at 2^32; the host reads and
// clears them after every submission.
#include "lib/path.glsl"

layout(scalar, set = 0) buffer CounterSums {
    uint count_sums[8];  // rays, shadow rays, non-finite samples, depth limit; then the same of forward rays
    uint flux_sums[];    // in pairs, whole and fraction (2^-32): escaped and lost to the depth limit, of backward rays and of
                         // forward rays; emitted, absorbed, taken by roulette (these may be negative)
};

Counters no_counters() {
    Counters c;
    c.rays = c.shadow_rays = c.non_finite = c.depth_limit = 0u;
    c.escaped = c.depth_limit_lost = 0.0;
#if FORWARD
    c.emitted = c.absorbed = c.roulette = 0.0;
#endif
    return c;
}

// Order does not matter: the sums are of integers. Below 2^31 a call.
void add_flux(uint slot, float value) {
    float whole = floor(clamp(value, -2e9, 2e9));
    uint fraction = uint(min((value - whole) * 4294967296.0, 4294967040.0));
    uint before = atomicAdd(flux_sums[2u * slot + 1u], fraction);
    uint carry = before + fraction < before ? 1u : 0u;
    atomicAdd(flux_sums[2u * slot], uint(int(whole)) + carry);
}

void store_counters(Counters c) {
    uvec4 counts = subgroupAdd(uvec4(c.rays, c.shadow_rays, c.non_finite, c.depth_limit));
    vec2 lost = subgroupAdd(vec2(c.escaped, c.depth_limit_lost));
#if FORWARD
    const uint first = 1u;
    vec3 forward = subgroupAdd(vec3(c.emitted, c.absorbed, c.roulette));
#else
    const uint first = 0u;
#endif
    if (subgroupElect()) {
        for (uint i = 0u; i < 4u; ++i)
            if (counts[i] != 0u) atomicAdd(count_sums[4u * first + i], counts[i]);
        add_flux(2u * first, lost.x);
        add_flux(2u * first + 1u, lost.y);
#if FORWARD
        add_flux(4u, forward.x);
        add_flux(5u, forward.y);
        add_flux(6u, forward.z);
#endif
    }
}

// Workgroup ids in an order that deals neighbouring groups to different halves: drivers that split a dispatch in contiguous
// parts over their threads then give each thread the same work.
uint scattered_lane() {
    uint groups = gl_NumWorkGroups.x;
    uint half_groups = (groups + 1u) / 2u;
    uint id = gl_WorkGroupID.x;
    uint group = id < half_groups ? 2u * id : 2u * (id - half_groups) + 1u;
    return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
