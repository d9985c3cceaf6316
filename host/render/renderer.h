// Passes over a scene: the schedule of kernels that fills the film of a receiver, or of several
// receivers that the same forward rays serve.
//
// A pass is one backward path a pixel, and what it brings depends on its number and the settings alone:
// random numbers, wavelengths, radius of merging and number of forward paths. Sums do not depend on their
// order. So a film is the same bits for the same passes, seed and device, whatever the batches and whoever
// rendered them.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/gpu/kernel.h"
#include "host/image/image.h"
#include "host/render/film.h"
#include "host/render/light_layers.h"
#include "host/render/power_ledger.h"
#include "host/render/render_counters.h"
#include "host/render/modes.h"
#include "host/render/ray_record.h"
#include "host/render/spectral_film.h"
#include "host/render/spectral_passes.h"
#include "host/render/start_media.h"
#include "host/render/views.h"
#include "host/scene/scene.h"

namespace etendue {

class ForwardRays;

// What --algorithm auto has come to, or what was asked for.
struct AlgorithmChoice {
    Algorithm algorithm = Algorithm::backward;
    double forward_paths = 1;  // a pixel and pass
    std::string reason;
    double pilot_seconds = 0;  // that it took to find out
    bool is_open = false;      // backward rays until a pilot tells
};
nlohmann::json to_json(const AlgorithmChoice& choice);
AlgorithmChoice choice_from_json(const nlohmann::json& json);

struct RenderSettings {
    uint32_t width = 512, height = 512;
    uint32_t receiver = no_record;  // RecordRef
    std::vector<FilmView> beside;   // further receivers, which the same forward rays serve
    uint32_t seed = 0;
    Algorithm algorithm = Algorithm::automatic;
    Schedule schedule = Schedule::automatic;
    bool connect = true;                    // bidirectional: vertices are connected, beside all else
    bool beams = true;                      // bidirectional: rays in thin media merge along their way
    double forward_paths = 1;               // a pixel and pass, where there are any
    std::optional<AlgorithmChoice> choice;  // of an earlier run: taken instead of algorithm and forward_paths
    uint64_t vertex_bytes = uint64_t(256) << 20;  // for vertices of forward paths; more make smaller passes
    float merge_radius = 1;                       // of the first pass, in widths of a pixel; > 0
    bool restarts_first = false;                  // before any pass: the film is not cleared until then
    uint32_t spectral_bins = 0;      // of a spectral image, where paths carry wavelengths; 0 = none
    bool record_rays = false;        // that cross receivers which record them, where there are forward rays
    bool stokes = false;             // S1 to S3, too, where paths carry polarization
    std::vector<LightLayer> layers;  // that hold a part of the light (light_layers.h); not with `stokes`
    bool ledger = false;             // forward rays tell what each material has absorbed
};

// The first view, and those beside it.
std::vector<FilmView> all_views(const RenderSettings& settings);
void set_views(RenderSettings& settings, std::span<const FilmView> views);  // at least one

// What accumulates over passes.
struct FilmState {
    std::vector<ExactSum> pixels;  // of Film, view after view
    PassSet passes;
    RenderCounters counters;
    std::vector<ExactSum> bins;  // of SpectralFilm, if there is one
};

// SPIR-V of a kernel, bytes, beyond which drivers take more than some seconds to compile it
// (tests/renders/kernel_size_test.cpp): of backward rays alone, which a first pass waits for; both ways; both
// ways with polarization.
constexpr uint64_t most_backward_kernel_bytes = 224 << 10, most_kernel_bytes = 256 << 10,
                   most_polarized_kernel_bytes = 336 << 10;

// What `techniques` are run by on the device. Where not even a kernel for each class would be within the
// budget, because it knows the classes at both ends of connections, vertices are no longer connected; where
// that is not enough either, rays in media merge at points, no longer along their way.
struct Techniques;
Schedule choose_schedule(Device& device, Scene& scene, Techniques& techniques);

// Making one compiles only what no renderer on the device has compiled yet: for another size of the image,
// make another one, with the first one's choice in the settings.
class Renderer {
  public:
    // Fails with one line where the scene cannot be rendered by that algorithm.
    Renderer(Device& device, Scene& scene, const RenderSettings& settings);
    ~Renderer();
    Renderer(const Renderer&) = delete;

    // The first passes that the film lacks, from begin_at() on. False: the interrupt ended it within a pass,
    // and the film must be restarted.
    bool render_passes(uint32_t count);
    void begin_at(uint64_t pass) { first_pass_ = pass; }
    // Asked within passes whether to stop, every few hundredths of a second where that can be.
    void set_interrupt(std::function<bool()> interrupt);
    // An empty film again; kernels and timings stay. What move_receiver has changed is seen from here on.
    void restart(uint32_t seed);
    // The same for another receiver or size of the first view, with at most as many pixels as at first.
    void restart(uint32_t seed, const FilmView& view);
    // How many passes take about `seconds` by the speed of the last batch; 1 before the first.
    uint32_t passes_in(double seconds) const;

    uint64_t passes() const { return passes_.count(); }
    const PassSet& pass_set() const { return passes_; }
    const RenderCounters& counters() const { return counters_; }
    const KernelTimings& timings() const { return timings_; }
    double seconds() const { return seconds_; }                  // in render_passes
    double warm_up_seconds() const { return warm_up_seconds_; }  // that the driver took to finish compiling
    Schedule schedule() const { return schedule_; }
    const AlgorithmChoice& choice() const { return choice_; }
    // The same algorithm is chosen for another reason than was known when the renderer was made.
    void explain(const AlgorithmChoice& choice) { choice_ = choice; }

    const std::vector<FilmView>& views() const { return views_.all(); }
    FilmShape film_shape(size_t view = 0) const;
    Image develop(bool errors = true, size_t view = 0) const;
    // The mean radiance of the first view alone, developed on the device.
    void read_picture(std::vector<glm::vec3>& picture);
    bool is_stokes() const { return film_->shape().stokes; }  // S1 to S3 are developed, too
    const std::vector<LightLayer>& layers() const { return settings_.layers; }
    // Adds the spectra of a spectral image, if it is one (add_spectra in spectral_film.h).
    void add_spectra(Image& image, size_t view = 0) const;
    RelativeError relative_error() const;  // of the view where it is greatest
    // Adds albedo.RGB, normal.XYZ and depth.Z of what the pixels see, by `count` primary rays a pixel.
    void add_aovs(Image& image, uint32_t count, size_t view = 0);

    CrossingSample take_crossings(size_t view);  // since the last call, of all films since then

    FilmState state() const;
    void restore(const FilmState& state);  // of a film of the same size

  private:
    struct Pipeline;
    struct FusedPipeline;
    struct WavefrontPipeline;
    void read_counters();
    void clear_counter_sums();
    // Of a view, of the sums of all.
    std::span<const ExactSum> part(std::span<const ExactSum> sums, size_t view) const;
    Device& device_;
    Scene& scene_;
    AlgorithmChoice choice_;
    RenderSettings settings_;
    Schedule schedule_;
    Views views_;
    LightLayers light_layers_;
    uint64_t most_pixels_;
    KernelTimings timings_;
    std::unique_ptr<Film> film_;
    std::optional<SpectralFilm> spectral_film_;
    Buffer counter_sums_;
    std::optional<PowerLedger> ledger_;
    std::unique_ptr<StartMedia> start_media_;
    uint64_t receiver_moves_;  // of the scene, that start_media_ knows of
    SpectralPasses spectra_;
    std::unique_ptr<ForwardRays> forward_;  // null = none
    std::unique_ptr<Pipeline> pipeline_;
    CommandList commands_;
    Buffer picture_;
    Kernel develop_film_;  // none until a picture is read
    RenderCounters counters_;
    PassSet passes_;
    uint64_t first_pass_ = 0;
    double seconds_ = 0, last_pass_seconds_ = 0, warm_up_seconds_ = 0;
};

}  // namespace etendue
