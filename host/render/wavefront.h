// Paths of one direction in memory, moved from event to event by a kernel a stage: rays and queues, the
// kernels between them, with a scattering kernel for all classes of surfaces or one for each
// (shaders/lib/wavefront.glsl).
#pragma once
#include <string>
#include <vector>

#include "host/render/techniques.h"

namespace etendue {

class Wavefront {
  public:
    enum class Direction { backward, forward };

    // How many paths a device is kept busy by.
    static uint32_t wanted_paths(const Device& device);

    // Room for `slots` paths. `buffers`: what the kernels need besides the scene and the
    // techniques.
    Wavefront(Device& device, Scene& scene, Direction direction, const Techniques& techniques, uint32_t slots,
              bool by_class, const BufferTable& buffers);

    uint32_t slots() const { return slots_; }
    BufferTable buffers() const;
    // Starts `paths` paths, at most slots(), and follows them to their ends. `values`: push constants of the
    // kernels that say which paths these are.
    void trace(CommandList& commands, uint32_t paths, const std::vector<PushValue>& values,
               KernelTimings& timings);
    void warm_up(CommandList& commands);  // dispatches every kernel on nothing

    // A kernel's `defines` with those of its class, for each class of surfaces in use.
    static std::vector<std::string> defines_by_class(const Scene& scene, const std::string& defines);
    // Groups of a dispatch over `items`, as many a lane.
    static uint32_t groups(const Kernel& kernel, uint32_t items, uint32_t items_a_lane);

  private:
    void make_scatter_kernels(Device& device, Scene& scene, BufferTable table, const std::string& defines,
                              bool by_class);
    void record_bounce(CommandList& commands, uint32_t bounce, uint32_t alive,
                       const std::vector<PushValue>& values);
    uint32_t slots_;
    uint32_t items_a_lane_;   // of a queue
    uint32_t shadow_queues_;  // shadow rays that a path casts at most from an event
    Buffer ray_origins_, ray_directions_, path_states_, shadow_rays_, ray_queue_, queue_counts_, hits_;
    Buffer class_queues_, class_counts_;  // with a kernel for each class
    Kernel emit_rays_, find_hits_, sort_hits_, find_occlusions_;
    std::vector<Kernel> scatter_paths_;  // one, or one for each class of surfaces
};

}  // namespace etendue
