// Forward rays of a pass: paths from the light sources, what they bring straight to the pixels, and the
// vertices that backward paths connect to and merge with.
#pragma once
#include <optional>
#include <utility>

#include "host/render/ray_record.h"
#include "host/render/renderer.h"
#include "host/render/techniques.h"
#include "host/render/vertex_map.h"
#include "host/render/wavefront.h"

namespace etendue {

// Radius of merging in pass `pass` (0, 1, …) relative to that of the first: squared, it falls as pass^(alpha
// - 1) with alpha = 2/3 (Knaus & Zwicker 2011, eq. 13), so that bias and variance both vanish.
double merge_radius_factor(uint64_t pass);

// Twin of struct ForwardPass in shaders/lib/forward_pass.glsl.
struct ForwardPass {
    uint32_t pass, seed, count;
    float merge_scale, short_scale, path_flux, inverse_power, splat_unit;
};
// Where there is room for their vertices.
uint32_t forward_paths_a_pass(const RenderSettings& settings);
// Of a pass with `count` forward paths.
ForwardPass describe_pass(const Scene& scene, const RenderSettings& settings, uint64_t pass, uint32_t count,
                          uint32_t seed);

class ForwardRays {
  public:
    // settings.schedule must not be automatic.
    ForwardRays(Device& device, Scene& scene, const RenderSettings& settings, const Techniques& techniques,
                const BufferTable& film);
    // What kernels of backward rays share.
    BufferTable buffers() const;
    // Traces the forward paths of a pass and sorts their vertices. Every pass begins with as many paths as
    // fitted in pass 0, and is repeated with fewer where their vertices do not fit: so what a pass traces
    // does not depend on which ones went before.
    void trace(CommandList& commands, uint64_t pass, uint32_t seed, KernelTimings& timings);
    // To be called before pass `first` is traced: finds out, where nobody knows yet and vertices are kept,
    // how many paths fit in pass 0, by tracing its forward paths. Whether it did: then counters are to be
    // cleared.
    bool find_fitting(CommandList& commands, uint64_t first, SpectralPasses& spectra, uint32_t seed,
                      KernelTimings& timings);
    void warm_up(CommandList& commands);
    // Paths traced, and passes that were repeated with fewer, since the last call.
    uint64_t take_paths() { return std::exchange(paths_, 0); }
    uint64_t take_splits() { return std::exchange(splits_, 0); }
    uint32_t paths_a_pass() const { return fitting_.value_or(all_); }
    void restart(const RenderSettings& settings);  // with other views
    // Of a view whose receiver records rays, where settings.record_rays asks for them: since the last call.
    CrossingSample take_crossings(size_t view);

  private:
    uint64_t splat_bytes() const;  // of the view at hand
    void trace_fitting(CommandList& commands, uint64_t pass, uint32_t seed, KernelTimings& timings);
    void trace_paths(CommandList& commands, KernelTimings& timings);
    const Scene& scene_;
    RenderSettings settings_;
    Techniques techniques_;
    uint32_t all_, count_;             // forward paths a pass: where their vertices fit, and now
    std::optional<uint32_t> fitting_;  // whose vertices fit in pass 0, once known
    uint64_t paths_ = 0, splits_ = 0;
    uint32_t expected_vertices_ = 0;
    Buffer pass_, splats_, path_ends_;
    std::optional<RayRecord> ray_record_;
    std::optional<VertexMap> vertices_;  // where vertices are connected or merged
    Kernel trace_forward_paths_;         // whole paths in one kernel, or
    uint32_t groups_ = 1;
    std::optional<Wavefront> wavefront_;  // a kernel a stage
};

}  // namespace etendue
