#include <algorithm>

#include "host/render/pipelines.h"

namespace etendue {

Renderer::FusedPipeline::FusedPipeline(Device& device, Scene& scene, const RenderSettings& s,
                                       const Techniques& techniques, ForwardRays* forward,
                                       SpectralPasses& spectra, const BufferTable& film)
    : Pipeline(s, forward, spectra) {
    trace_paths = make_kernel(device, scene, "kernels/trace_paths.comp", film, techniques.backward_defines());
    // A lane takes several pixels, so that it is refilled when a path ends; a GPU wants all pixels in flight.
    const uint32_t pixels = settings.width * settings.height;
    const uint32_t pixels_a_group = trace_paths.group_size() * (device.description.type == "CPU" ? 8 : 1);
    groups = std::clamp((pixels + pixels_a_group - 1) / pixels_a_group, 1u, max_groups);
}

void Renderer::FusedPipeline::run(CommandList& commands, uint64_t first, uint32_t count,
                                  KernelTimings& timings) {
    // With forward rays pass by pass: each meets its own.
    for (uint32_t done = 0, at_once; done < count; done += at_once) {
        at_once = forward ? 1 : std::min(count - done, spectra.capacity());
        spectra.write(first + done, at_once, settings.seed);
        if (forward) forward->trace(commands, first + done, settings.seed, timings);
        commands.dispatch(trace_paths, groups,
                          {{"receiver", settings.receiver},
                           {"width", settings.width},
                           {"height", settings.height},
                           {"first_sample", uint32_t(first) + done},
                           {"sample_count", at_once},
                           {"seed", settings.seed}});
        commands.run(&timings);
    }
}

void Renderer::FusedPipeline::warm_up(CommandList& commands) {
    commands.dispatch(trace_paths, 1, {{"receiver", settings.receiver}});  // of an image without pixels
    commands.run();
}

}  // namespace etendue
