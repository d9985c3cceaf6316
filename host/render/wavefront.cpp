#include "host/render/wavefront.h"

#include <algorithm>

#include "host/error.h"

namespace etendue {
namespace {

constexpr uint32_t bounces_a_submission = 8;
constexpr uint32_t counts_a_bounce = 3;  // twin of COUNTS_A_BOUNCE in shaders/lib/wavefront.glsl
constexpr uint32_t all_counts = counts_a_bounce * (bounces_a_submission + 1);
constexpr uint32_t cpu_paths = 1 << 16, gpu_paths = 1 << 20;
constexpr uint64_t ray_bytes = 16;  // of RayOrigins and RayDirections
constexpr const char* occlusions_file = "kernels/find_occlusions.comp";

}  // namespace

uint32_t Wavefront::wanted_paths(const Device& device) {
    return device.description.type == "CPU" ? cpu_paths : gpu_paths;
}

uint32_t Wavefront::groups(const Kernel& kernel, uint32_t items, uint32_t items_a_lane) {
    const uint32_t size = kernel.group_size() * items_a_lane;
    return std::max(2u, (items + size - 1) / size);
}

std::vector<std::string> Wavefront::defines_by_class(const Scene& scene, const std::string& defines) {
    const std::vector<const ClassInfo*>& classes = scene.classes.at(Interface::surface);
    std::vector<std::string> all;
    for (const ClassInfo* info : classes)
        all.push_back(defines + fmt::format("#define SCATTER_CLASS_COUNT {}\n#define SCATTER_CLASS {}\n"
                                            "#define ONLY_SURFACE_CLASS {}\n",
                                            classes.size(), all.size(), info->tag));
    return all;
}

Wavefront::Wavefront(Device& device, Scene& scene, Direction direction, const Techniques& techniques,
                     uint32_t slots, bool by_class, const BufferTable& buffers)
    : slots_(slots), items_a_lane_(device.description.type == "CPU" ? 16 : 1) {
    const bool forward = direction == Direction::forward;
    shadow_queues_ = scene.features.light_count == 0 ? 0 : techniques.connect && !forward ? 2 : 1;
    const std::string all = forward ? techniques.forward_defines() : techniques.backward_defines();
    const char* emit = forward ? "kernels/emit_light_rays.comp" : "kernels/emit_camera_rays.comp";
    const char* find = "kernels/find_hits.comp";
    const std::string queued = "#define HAS_RAY_QUEUE 1\n";
    const uint64_t n = slots;
    ray_origins_ = Buffer(device, n * ray_bytes, "RayOrigins");
    ray_directions_ = Buffer(device, n * ray_bytes, "RayDirections");
    path_states_ = Buffer(device, n * element_bytes(device, scene, emit, all, "PathStates"), "PathStates");
    ray_queue_ = Buffer(device, n * 8, "RayQueue");
    queue_counts_ = Buffer(device, all_counts * 4, "QueueCounts");
    hits_ = Buffer(device, n * element_bytes(device, scene, find, queued, "Hits"), "Hits");
    if (shadow_queues_ > 0)
        shadow_rays_ = Buffer(
            device, n * shadow_queues_ * element_bytes(device, scene, occlusions_file, all, "ShadowRays"),
            "ShadowRays");
    BufferTable table = this->buffers();
    table.insert(buffers.begin(), buffers.end());
    emit_rays_ = make_kernel(device, scene, emit, table, all);
    find_hits_ = make_kernel(device, scene, find, table, queued);
    make_scatter_kernels(device, scene, table, all, by_class);
    if (shadow_queues_ > 0) find_occlusions_ = make_kernel(device, scene, occlusions_file, table, all);
}

BufferTable Wavefront::buffers() const {
    return {{"RayOrigins", &ray_origins_},
            {"RayDirections", &ray_directions_},
            {"PathStates", &path_states_},
            {"ShadowRays", &shadow_rays_},
            {"RayQueue", &ray_queue_},
            {"QueueCounts", &queue_counts_},
            {"Hits", &hits_}};
}

void Wavefront::make_scatter_kernels(Device& device, Scene& scene, BufferTable table,
                                     const std::string& defines, bool by_class) {
    const char* file = "kernels/scatter_paths.comp";
    const std::vector<const ClassInfo*>& classes = scene.classes[Interface::surface];
    if (!by_class || classes.empty()) {
        scatter_paths_.push_back(make_kernel(device, scene, file, table, defines));
        return;
    }
    const size_t count = classes.size();
    const std::vector<std::string> scattered = defines_by_class(scene, defines);
    class_queues_ = Buffer(device, uint64_t(slots_) * 4 * count, "ClassQueues");
    class_counts_ = Buffer(device, bounces_a_submission * 4 * count, "ClassCounts");
    table["ClassQueues"] = &class_queues_;
    table["ClassCounts"] = &class_counts_;
    std::vector<std::string> tags;
    for (const ClassInfo* info : classes) tags.push_back(fmt::format("{}u", info->tag));
    sort_hits_ = make_kernel(device, scene, "kernels/sort_hits.comp", table,
                             defines + fmt::format("#define SCATTER_CLASS_COUNT {0}\n"
                                                   "const uint SCATTER_CLASS_TAGS[{0}] = uint[{0}]({1});\n",
                                                   count, fmt::join(tags, ", ")));
    for (const std::string& of_class : scattered)
        scatter_paths_.push_back(make_kernel(device, scene, file, table, of_class));
}

void Wavefront::trace(CommandList& commands, uint32_t paths, const std::vector<PushValue>& values,
                      KernelTimings& timings) {
    std::vector<PushValue> with_paths = values;
    with_paths.push_back({"paths", paths});
    commands.fill(queue_counts_, 0);
    commands.dispatch(emit_rays_, groups(emit_rays_, paths, 1), with_paths);
    uint32_t alive = paths;
    while (alive > 0) {
        if (class_counts_) commands.fill(class_counts_, 0);
        for (uint32_t bounce = 0; bounce < bounces_a_submission; ++bounce)
            record_bounce(commands, bounce, alive, values);
        commands.run(&timings);
        auto counts = queue_counts_.read_array<uint32_t>(all_counts);
        alive = counts[counts_a_bounce * bounces_a_submission];
        std::fill(counts.begin(), counts.end(), 0u);
        counts[0] = alive;
        queue_counts_.write(counts.data(), counts.size() * 4);
    }
}

void Wavefront::record_bounce(CommandList& commands, uint32_t bounce, uint32_t alive,
                              const std::vector<PushValue>& values) {
    // The queues take turns; a submission has an even number of bounces, so each starts with the first.
    const uint32_t read = bounce % 2 ? slots_ : 0, write = bounce % 2 ? 0 : slots_;
    const uint32_t counter = counts_a_bounce * bounce;
    const bool sorts = bool(sort_hits_);
    commands.dispatch(find_hits_, groups(find_hits_, alive, items_a_lane_),
                      {{"counter", counter}, {"read_queue", read}});
    if (sorts)
        commands.dispatch(sort_hits_, groups(sort_hits_, alive, items_a_lane_),
                          {{"bounce", bounce}, {"read_queue", read}, {"slots", slots_}});
    for (uint32_t c = 0; c < scatter_paths_.size(); ++c) {
        std::vector<PushValue> all = values;
        all.insert(all.end(), {{"bounce", bounce},
                               {"read_queue", sorts ? c * slots_ : read},
                               {"write_queue", write},
                               {"slots", slots_}});
        commands.dispatch(scatter_paths_[c], groups(scatter_paths_[c], alive, items_a_lane_), all);
    }
    for (uint32_t q = 0; q < shadow_queues_; ++q) {
        std::vector<PushValue> all = values;
        all.insert(all.end(), {{"counter", counter + 1 + q}, {"first_ray", q * slots_}});
        commands.dispatch(find_occlusions_, groups(find_occlusions_, alive, items_a_lane_), all);
    }
}

void Wavefront::warm_up(CommandList& commands) {
    commands.fill(queue_counts_, 0);
    if (class_counts_) commands.fill(class_counts_, 0);
    for (const Kernel* kernel : {&emit_rays_, &find_hits_, &sort_hits_, &find_occlusions_})
        if (*kernel) commands.dispatch(*kernel, 1);
    for (const Kernel& kernel : scatter_paths_) commands.dispatch(kernel, 1);
    commands.run();
}

}  // namespace etendue
