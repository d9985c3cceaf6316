// Turns the counts of bucket_starts into their exclusive prefix sums, in place, in three dispatches.
// Stage 0: sums of runs of buckets; stage 1, one workgroup: sums of all runs before each; stage 2: starts.
// Reads and writes: bucket_starts, bucket_sums. Barrier expected: between the stages and after the last.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint stage; };
#include "lib/vertex_grid.glsl"

layout(scalar, set = 0) buffer BucketSums { uint bucket_sums[]; };  // of runs

const uint RUN = 64u;  // buckets that a lane takes; twin in host/render/vertex_map.cpp

shared uint lane_sums[64];

void scan_runs(uint runs) {
    uint lane = gl_LocalInvocationID.x;
    uint share = (runs + 63u) / 64u;
    uint first = min(lane * share, runs), end = min(first + share, runs);
    uint sum = 0u;
    for (uint i = first; i < end; ++i) sum += bucket_sums[i];
    lane_sums[lane] = sum;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < lane; ++i) before += lane_sums[i];
    for (uint i = first; i < end; ++i) {
        uint run_sum = bucket_sums[i];
        bucket_sums[i] = before;
        before += run_sum;
    }
}

void main() {
    uint buckets = bucket_mask + 1u;
    uint runs = (buckets + RUN - 1u) / RUN;
    if (stage == 1u) {
        if (gl_WorkGroupID.x == 0u) scan_runs(runs);
        return;
    }
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint run = gl_GlobalInvocationID.x; run < runs; run += stride) {
        uint first = run * RUN, end = min(first + RUN, buckets);
        uint sum = stage == 0u ? 0u : bucket_sums[run];
        for (uint i = first; i < end; ++i) {
            uint count = bucket_starts[i];
            if (stage == 2u) bucket_starts[i] = sum;
            sum += count;
        }
        if (stage == 0u) bucket_sums[run] = sum;
        else if (end == buckets) bucket_starts[buckets] = sum;
    }
}
