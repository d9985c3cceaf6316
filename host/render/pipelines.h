// The schedules of a pass. A pipeline owns its kernels and path buffers and records passes into a command
// list.
#pragma once
#include "host/render/forward_rays.h"
#include "host/render/renderer.h"

namespace etendue {

struct Renderer::Pipeline {
    Pipeline(const RenderSettings& settings, ForwardRays* forward) : settings(settings), forward(forward) {}
    virtual ~Pipeline() = default;
    // Runs passes [first, first + count).
    virtual void run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) = 0;
    // Dispatches every kernel on nothing: drivers finish compiling at the first dispatch.
    virtual void warm_up(CommandList& commands) = 0;
    RenderSettings settings;
    ForwardRays* forward;  // null = none
};

struct Renderer::FusedPipeline : Pipeline {
    FusedPipeline(Device& device, Scene& scene, const RenderSettings& settings, const Techniques& techniques,
                  ForwardRays* forward, const BufferTable& film);
    void run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) override;
    void warm_up(CommandList& commands) override;
    Kernel trace_paths;
    uint32_t groups = 1;
};

struct Renderer::WavefrontPipeline : Pipeline {
    WavefrontPipeline(Device& device, Scene& scene, const RenderSettings& settings,
                      const Techniques& techniques, ForwardRays* forward, const BufferTable& film,
                      bool by_class);
    void run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) override;
    void warm_up(CommandList& commands) override;
    // One batch: `samples` samples of the pixels [first_pixel, first_pixel + pixels).
    void run_tile(CommandList& commands, uint32_t first_pixel, uint32_t pixels, uint32_t first_sample,
                  uint32_t samples, KernelTimings& timings);
    void make_scatter_kernels(Device& device, Scene& scene, BufferTable table, bool by_class);
    uint32_t slots = 0;         // paths in memory
    uint32_t items_a_lane = 1;  // of a queue
    Buffer ray_origins, ray_directions, path_states, shadow_rays, ray_queue, queue_counts, hits,
        hit_instances;
    Buffer class_queues, class_counts;  // with a kernel for each class
    Kernel emit_camera_rays, find_hits, sort_hits, find_occlusions, accumulate_film;
    std::vector<Kernel> scatter_paths;  // one, or one for each class of surfaces
};

}  // namespace etendue
