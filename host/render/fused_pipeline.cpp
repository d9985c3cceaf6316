#include <algorithm>
#include <chrono>

#include "host/render/pipelines.h"

namespace etendue {
namespace {

constexpr double band_seconds = 0.025;  // of a dispatch, where somebody may interrupt
// Turns of loops that a path takes on average, generously; most are steps through the hierarchy.
constexpr uint32_t turns_a_path = 1000;

}  // namespace

Renderer::FusedPipeline::FusedPipeline(Device& device, Scene& scene, const RenderSettings& s,
                                       const Techniques& techniques, ForwardRays* forward,
                                       SpectralPasses& spectra, Film& film, const BufferTable& buffers)
    : Pipeline(s, forward, spectra, film) {
    trace_paths =
        make_kernel(device, scene, "kernels/trace_paths.comp", buffers, techniques.backward_defines());
    // A lane takes several pixels, so that it is refilled when a path ends; a GPU wants all pixels in flight.
    // Where the driver ends loops early a lane gets no more paths than fit.
    const uint32_t turns = device.description.max_loop_turns;
    pixels_a_group = trace_paths.group_size() * (device.description.type == "CPU" && turns == 0 ? 8 : 1);
    most_at_once = turns > 0 ? std::max(1u, turns / turns_a_path) : ~0u;
}

uint32_t Renderer::FusedPipeline::groups(uint32_t pixels) const {
    return std::clamp((pixels + pixels_a_group - 1) / pixels_a_group, 1u, max_groups);
}

bool Renderer::FusedPipeline::run(CommandList& commands, uint64_t first, uint32_t count,
                                  KernelTimings& timings) {
    // With forward rays pass by pass: each meets its own.
    for (uint32_t done = 0, at_once; done < count; done += at_once) {
        at_once = forward ? 1 : std::min({count - done, spectra.capacity(), most_at_once});
        at_once = film.begin_passes(first + done, at_once);
        spectra.write(first + done, at_once, settings.seed);
        if (forward) forward->trace(commands, first + done, settings.seed, timings);
        const uint32_t all = uint32_t(film.shape().pixels());
        uint32_t band = all;  // pixels of a dispatch: all, unless somebody may interrupt
        for (uint32_t pixel = 0; pixel < all; pixel += band) {
            if (interrupted()) return false;
            if (interrupt) band = uint32_t(std::clamp(pixels_a_second * band_seconds / at_once, 4096.0, 1e9));
            const uint32_t pixels = std::min(band, all - pixel);
            const auto start = std::chrono::steady_clock::now();
            commands.dispatch(trace_paths, groups(pixels),
                              {{"pixels", all},
                               {"first_pixel", pixel},
                               {"end_pixel", pixel + pixels},
                               {"first_sample", uint32_t(first) + done},
                               {"sample_count", at_once},
                               {"sample_passes", film.sample_passes()},
                               {"seed", settings.seed}});
            commands.run(&timings);
            pixels_a_second = double(pixels) * at_once /
                              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
    }
    return true;
}

void Renderer::FusedPipeline::warm_up(CommandList& commands) {
    commands.dispatch(trace_paths, 1);  // of no pixels
    commands.run();
}

}  // namespace etendue
