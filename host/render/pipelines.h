// The schedules of a pass. A pipeline owns its kernels and path buffers and records passes into a command list.
#pragma once
#include "host/render/renderer.h"

namespace etendue {

struct Renderer::Pipeline {
    virtual ~Pipeline() = default;
    // Runs passes [first, first + count).
    virtual void run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) = 0;
};

struct Renderer::FusedPipeline : Pipeline {
    FusedPipeline(Device& device, Scene& scene, const RenderSettings& settings, const Buffer& film, const Buffer& counters);
    void run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) override;
    RenderSettings settings;
    Kernel trace_paths;
    uint32_t groups = 1;
};

}  // namespace etendue
