// Counters of a kernel: summed over the subgroup, then added to one row of sums. Counts wrap at 2^32; the host reads and
// clears them after every submission.
#include "lib/path.glsl"

layout(scalar, set = 0) buffer CounterSums {
    uint count_sums[4];      // rays, shadow rays, non-finite samples, depth limit
    uint importance_sums[];  // escaped, lost to the depth limit; whole and fraction (1/65536), in pairs
};

Counters no_counters() { return Counters(0u, 0u, 0u, 0u, 0.0, 0.0); }

void add_importance(uint slot, float value) {
    uint whole = uint(value);
    uint fraction = uint((value - float(whole)) * 65536.0);
    uint before = atomicAdd(importance_sums[2u * slot + 1u], fraction);
    if (before + fraction < before) whole += 65536u;  // the sum of fractions has wrapped: carry
    atomicAdd(importance_sums[2u * slot], whole);
}

void store_counters(Counters c) {
    uvec4 counts = subgroupAdd(uvec4(c.rays, c.shadow_rays, c.non_finite, c.depth_limit));
    float escaped = subgroupAdd(c.escaped);
    float lost = subgroupAdd(c.depth_limit_lost);
    if (subgroupElect()) {
        for (uint i = 0u; i < 4u; ++i)
            if (counts[i] != 0u) atomicAdd(count_sums[i], counts[i]);
        if (escaped > 0.0) add_importance(0u, min(escaped, 4e9));
        if (lost > 0.0) add_importance(1u, min(lost, 4e9));
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
