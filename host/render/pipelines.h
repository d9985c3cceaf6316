// The schedules of a pass. A pipeline owns its kernels and path buffers and records passes into a command
// list.
#pragma once
#include "host/render/forward_rays.h"
#include "host/render/renderer.h"
#include "host/render/wavefront.h"

namespace etendue {

struct Renderer::Pipeline {
    Pipeline(const RenderSettings& settings, ForwardRays* forward, SpectralPasses& spectra, Film& film)
        : settings(settings), forward(forward), spectra(spectra), film(film) {}
    virtual ~Pipeline() = default;
    // Runs passes [first, first + count). False: interrupted.
    virtual bool run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) = 0;
    // Dispatches every kernel on nothing: drivers finish compiling at the first dispatch.
    virtual void warm_up(CommandList& commands) = 0;
    RenderSettings settings;
    ForwardRays* forward;  // null = none
    SpectralPasses& spectra;
    Film& film;
    std::function<bool()> interrupt;  // may be empty
    bool interrupted() const { return interrupt && interrupt(); }
};

struct Renderer::FusedPipeline : Pipeline {
    FusedPipeline(Device& device, Scene& scene, const RenderSettings& settings, const Techniques& techniques,
                  ForwardRays* forward, SpectralPasses& spectra, Film& film, const BufferTable& buffers);
    bool run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) override;
    void warm_up(CommandList& commands) override;
    uint32_t groups(uint32_t pixels) const;
    Kernel trace_paths;
    uint32_t pixels_a_group, most_at_once;  // passes of a dispatch
    double pixels_a_second = 0;             // of the last dispatch; 0 = there was none
};

struct Renderer::WavefrontPipeline : Pipeline {
    WavefrontPipeline(Device& device, Scene& scene, const RenderSettings& settings,
                      const Techniques& techniques, ForwardRays* forward, SpectralPasses& spectra, Film& film,
                      const BufferTable& buffers, bool by_class);
    bool run(CommandList& commands, uint64_t first, uint32_t count, KernelTimings& timings) override;
    void warm_up(CommandList& commands) override;
    // One batch: `samples` samples of the pixels [first_pixel, first_pixel + pixels).
    void run_tile(CommandList& commands, uint32_t first_pixel, uint32_t pixels, uint32_t first_sample,
                  uint32_t samples, KernelTimings& timings);
    Wavefront paths;
    Kernel record_samples;
};

}  // namespace etendue
