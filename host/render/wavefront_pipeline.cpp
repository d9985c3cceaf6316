#include <algorithm>

#include "host/render/pipelines.h"

namespace etendue {
namespace {

// As many samples of all pixels as keep the device busy; with forward rays one, which meets those of its
// pass.
uint32_t slots_for(const Device& device, uint32_t pixels, bool forward) {
    const uint32_t wanted = Wavefront::wanted_paths(device);
    if (pixels >= wanted) return wanted;
    return forward ? pixels : wanted / pixels * pixels;
}

BufferTable joined(BufferTable a, const BufferTable& b) {
    a.insert(b.begin(), b.end());
    return a;
}

}  // namespace

Renderer::WavefrontPipeline::WavefrontPipeline(Device& device, Scene& scene, const RenderSettings& s,
                                               const Techniques& techniques, ForwardRays* forward,
                                               SpectralPasses& spectra, Film& film,
                                               const BufferTable& buffers, bool by_class)
    : Pipeline(s, forward, spectra, film),
      paths(device, scene, Wavefront::Direction::backward, techniques,
            slots_for(device, uint32_t(film.shape().pixels()), forward), by_class, buffers),
      record_samples(make_kernel(device, scene, "kernels/record_samples.comp",
                                 joined(buffers, paths.buffers()), techniques.backward_defines())) {}

bool Renderer::WavefrontPipeline::run(CommandList& commands, uint64_t first, uint32_t count,
                                      KernelTimings& timings) {
    const uint32_t pixels = uint32_t(film.shape().pixels());
    const uint32_t tile = std::min(pixels, paths.slots());
    const uint32_t samples_at_once =
        forward ? 1 : std::min(std::max(1u, paths.slots() / pixels), spectra.capacity());
    for (uint32_t sample = 0, at_once; sample < count; sample += at_once) {
        at_once = film.begin_passes(first + sample, std::min(samples_at_once, count - sample));
        spectra.write(first + sample, at_once, settings.seed);
        if (forward) forward->trace(commands, first + sample, settings.seed, timings);
        for (uint32_t pixel = 0; pixel < pixels; pixel += tile) {
            if (interrupted()) return false;
            run_tile(commands, pixel, std::min(tile, pixels - pixel), uint32_t(first) + sample, at_once,
                     timings);
        }
    }
    return true;
}

void Renderer::WavefrontPipeline::run_tile(CommandList& commands, uint32_t first_pixel, uint32_t pixels,
                                           uint32_t first_sample, uint32_t samples, KernelTimings& timings) {
    paths.trace(commands, pixels * samples,
                {{"first_pixel", first_pixel},
                 {"tile_pixels", pixels},
                 {"first_sample", first_sample},
                 {"seed", settings.seed}},
                timings);
    commands.dispatch(record_samples, Wavefront::groups(record_samples, pixels, 1),
                      {{"first_pixel", first_pixel},
                       {"tile_pixels", pixels},
                       {"pixels", uint32_t(film.shape().pixels())},
                       {"sample_passes", film.sample_passes()},
                       {"first_sample", first_sample},
                       {"samples_at_once", samples}});
    commands.run(&timings);
}

void Renderer::WavefrontPipeline::warm_up(CommandList& commands) {
    paths.warm_up(commands);
    commands.dispatch(record_samples, 1);
    commands.run();
}

}  // namespace etendue
