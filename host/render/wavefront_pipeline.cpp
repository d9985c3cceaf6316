#include <fmt/format.h>

#include <algorithm>

#include "host/render/pipelines.h"

namespace etendue {
namespace {

constexpr uint32_t bounces_a_submission = 8;
constexpr uint32_t cpu_slots = 1 << 16, gpu_slots = 1 << 20;

}  // namespace

Renderer::WavefrontPipeline::WavefrontPipeline(Device& device, Scene& scene, const RenderSettings& s,
                                               const Techniques& techniques, ForwardRays* forward,
                                               const BufferTable& film, bool by_class)
    : Pipeline(s, forward) {
    const bool cpu = device.description.type == "CPU";
    const uint32_t pixels = settings.width * settings.height;
    const uint32_t wanted = cpu ? cpu_slots : gpu_slots;
    slots = pixels >= wanted ? wanted : wanted / pixels * pixels;
    items_a_lane = cpu ? 16 : 1;
    ray_origins = Buffer(device, uint64_t(slots) * 16, "RayOrigins");
    ray_directions = Buffer(device, uint64_t(slots) * 16, "RayDirections");
    path_states = Buffer(device, uint64_t(slots) * 48, "PathStates");
    shadow_rays = Buffer(device, uint64_t(slots) * 48, "ShadowRays");
    ray_queue = Buffer(device, uint64_t(slots) * 8, "RayQueue");
    queue_counts = Buffer(device, (2 * bounces_a_submission + 2) * 4, "QueueCounts");
    hits = Buffer(device, uint64_t(slots) * 16, "Hits");
    hit_instances = Buffer(device, scene.features.instances ? uint64_t(slots) * 4 : 0, "HitInstances");
    BufferTable table = {{"RayOrigins", &ray_origins},
                         {"RayDirections", &ray_directions},
                         {"PathStates", &path_states},
                         {"ShadowRays", &shadow_rays},
                         {"RayQueue", &ray_queue},
                         {"QueueCounts", &queue_counts},
                         {"Hits", &hits},
                         {"HitInstances", &hit_instances}};
    table.insert(film.begin(), film.end());
    emit_camera_rays = make_kernel(device, scene, "kernels/emit_camera_rays.comp", table);
    find_hits = make_kernel(device, scene, "kernels/find_hits.comp", table, "#define HAS_RAY_QUEUE 1\n");
    make_scatter_kernels(device, scene, table, by_class);
    if (scene.features.light_count > 0)
        find_occlusions = make_kernel(device, scene, "kernels/find_occlusions.comp", table);
    accumulate_film = make_kernel(device, scene, "kernels/accumulate_film.comp", table);
}

void Renderer::WavefrontPipeline::make_scatter_kernels(Device& device, Scene& scene, BufferTable table,
                                                       bool by_class) {
    const char* file = "kernels/scatter_paths.comp";
    const std::vector<const ClassInfo*>& classes = scene.classes[Interface::surface];
    if (!by_class || classes.empty()) {
        scatter_paths.push_back(make_kernel(device, scene, file, table));
        return;
    }
    const size_t count = classes.size();
    class_queues = Buffer(device, uint64_t(slots) * 4 * count, "ClassQueues");
    class_counts = Buffer(device, bounces_a_submission * 4 * count, "ClassCounts");
    table["ClassQueues"] = &class_queues;
    table["ClassCounts"] = &class_counts;
    std::vector<std::string> tags;
    for (const ClassInfo* info : classes) tags.push_back(fmt::format("{}u", info->tag));
    const std::string shared = fmt::format("#define SCATTER_CLASS_COUNT {}\n", count);
    sort_hits = make_kernel(device, scene, "kernels/sort_hits.comp", table,
                            shared + fmt::format("const uint SCATTER_CLASS_TAGS[{0}] = uint[{0}]({1});\n",
                                                 count, fmt::join(tags, ", ")));
    for (size_t c = 0; c < count; ++c)
        scatter_paths.push_back(
            make_kernel(device, scene, file, table,
                        shared + fmt::format("#define SCATTER_CLASS {}\n#define ONLY_SURFACE_CLASS {}\n", c,
                                             classes[c]->tag)));
}

void Renderer::WavefrontPipeline::run(CommandList& commands, uint64_t first, uint32_t count,
                                      KernelTimings& timings) {
    const uint32_t pixels = settings.width * settings.height;
    const uint32_t tile = std::min(pixels, slots);
    const uint32_t samples_at_once = std::max(1u, slots / pixels);
    for (uint32_t sample = 0; sample < count; sample += samples_at_once)
        for (uint32_t pixel = 0; pixel < pixels; pixel += tile)
            run_tile(commands, pixel, std::min(tile, pixels - pixel), uint32_t(first) + sample,
                     std::min(samples_at_once, count - sample), timings);
}

void Renderer::WavefrontPipeline::run_tile(CommandList& commands, uint32_t first_pixel, uint32_t pixels,
                                           uint32_t first_sample, uint32_t samples, KernelTimings& timings) {
    const auto groups = [&](const Kernel& kernel, uint32_t items, uint32_t a_lane) {
        const uint32_t size = kernel.group_size() * a_lane;
        return std::max(2u, (items + size - 1) / size);
    };
    const uint32_t paths = pixels * samples;
    commands.fill(queue_counts, 0);
    commands.dispatch(emit_camera_rays, groups(emit_camera_rays, paths, 1),
                      {{"receiver", settings.receiver},
                       {"slots", paths},
                       {"first_pixel", first_pixel},
                       {"tile_pixels", pixels},
                       {"first_sample", first_sample},
                       {"width", settings.width},
                       {"height", settings.height},
                       {"seed", settings.seed}});
    uint32_t alive = paths;
    for (uint32_t total = 0; alive > 0; total += bounces_a_submission) {
        if (class_counts) commands.fill(class_counts, 0);
        for (uint32_t bounce = 0; bounce < bounces_a_submission; ++bounce) {
            // The queues take turns; a submission has an even number of bounces, so each starts with the
            // first.
            const uint32_t read = bounce % 2 ? slots : 0, write = bounce % 2 ? 0 : slots;
            commands.dispatch(find_hits, groups(find_hits, alive, items_a_lane),
                              {{"bounce", bounce}, {"read_queue", read}});
            if (!sort_hits.name().empty())
                commands.dispatch(sort_hits, groups(sort_hits, alive, items_a_lane),
                                  {{"bounce", bounce}, {"read_queue", read}, {"slots", slots}});
            for (uint32_t c = 0; c < scatter_paths.size(); ++c)
                commands.dispatch(scatter_paths[c], groups(scatter_paths[c], alive, items_a_lane),
                                  {{"bounce", bounce},
                                   {"read_queue", sort_hits.name().empty() ? read : c * slots},
                                   {"write_queue", write},
                                   {"first_pixel", first_pixel},
                                   {"tile_pixels", pixels},
                                   {"first_sample", first_sample},
                                   {"width", settings.width},
                                   {"height", settings.height},
                                   {"seed", settings.seed}});
            if (!find_occlusions.name().empty())
                commands.dispatch(find_occlusions, groups(find_occlusions, alive, items_a_lane),
                                  {{"bounce", bounce}});
        }
        commands.run(&timings);
        auto counts = queue_counts.read_array<uint32_t>(2 * bounces_a_submission + 2);
        alive = counts[2 * bounces_a_submission];
        std::fill(counts.begin(), counts.end(), 0u);
        counts[0] = alive;
        queue_counts.write(counts.data(), counts.size() * 4);
    }
    commands.dispatch(accumulate_film, groups(accumulate_film, pixels, 1),
                      {{"first_pixel", first_pixel}, {"tile_pixels", pixels}, {"samples", samples}});
    commands.run(&timings);
}

void Renderer::WavefrontPipeline::warm_up(CommandList& commands) {
    commands.fill(queue_counts, 0);
    if (class_counts) commands.fill(class_counts, 0);
    for (const Kernel* kernel :
         {&emit_camera_rays, &find_hits, &sort_hits, &find_occlusions, &accumulate_film})
        if (!kernel->name().empty()) commands.dispatch(*kernel, 1);
    for (const Kernel& kernel : scatter_paths) commands.dispatch(kernel, 1);
    commands.run();
}

}  // namespace etendue
