#include "host/render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "host/error.h"
#include "host/gpu/compile_aside.h"
#include "host/render/automatic.h"
#include "host/render/pipelines.h"

namespace etendue {
namespace {

// Twin of CounterSums in shaders/lib/counters.glsl.
struct CounterSums {
    uint32_t counts[8];
    uint32_t flux[14];  // whole and 2^-32, in pairs
    double flux_sum(int i) const { return double(int32_t(flux[2 * i])) + flux[2 * i + 1] / 4294967296.0; }
};

// Kernels that no cache had: the driver has most likely not seen them either.
std::vector<std::filesystem::path> newly_compiled(const Scene& scene) {
    std::vector<std::filesystem::path> files;
    for (const KernelReport& kernel : scene.kernels)
        if (!kernel.from_store && !kernel.from_cache && !kernel.spirv.empty()) files.push_back(kernel.spirv);
    return files;
}

}  // namespace

nlohmann::json to_json(const AlgorithmChoice& c) {
    return {{"algorithm", algorithm_name(c.algorithm)},
            {"forward_paths", c.forward_paths},
            {"reason", c.reason},
            {"pilot_seconds", c.pilot_seconds},
            {"is_open", c.is_open}};
}

AlgorithmChoice choice_from_json(const nlohmann::json& json) {
    AlgorithmChoice c;
    for (const Algorithm a : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional})
        if (json.at("algorithm") == algorithm_name(a)) c.algorithm = a;
    c.forward_paths = json.at("forward_paths");
    c.reason = json.at("reason");
    c.pilot_seconds = json.at("pilot_seconds");
    c.is_open = json.value("is_open", false);
    return c;
}

// Measured on lavapipe (Mesa 25): state in registers always wins, by 1.1 (a thousand lights) to 2.8
// (materials), also where kernels hold seven classes or scenes have 50,000 triangles; but one kernel of
// everything may be larger than drivers compile while one waits. A kernel for each class never won there
// (Mesa 25 and 22.3: 30 % slower, and as much longer to compile in all): it is for scenes whose classes
// together exceed the budget. On a GPU long traversals of few lanes hold up the shading of all: there the
// hierarchy should fit in the cache, and few classes share a kernel. A bent ray takes many steps, each of
// which would be a bounce with its kernels.
Schedule choose_schedule(Device& device, Scene& scene, Techniques& techniques) {
    if (device.description.type == "CPU") {
        const uint64_t most = scene.features.polarization ? most_polarized_kernel_bytes
                              : techniques.forward        ? most_kernel_bytes
                                                          : most_backward_kernel_bytes;
        const auto fits = [&](const char* file, const std::string& defines) {
            return spirv_bytes(device, scene, file, defines) <= most;
        };
        const char* scatter = "kernels/scatter_paths.comp";
        const std::string defines = techniques.backward_defines();
        if (fits("kernels/trace_paths.comp", defines)) return Schedule::fused;
        if (fits(scatter, defines)) return Schedule::wavefront;
        const auto all_fit = [&] {
            const auto by_class = Wavefront::defines_by_class(scene, techniques.backward_defines());
            return std::all_of(by_class.begin(), by_class.end(),
                               [&](const std::string& of_class) { return fits(scatter, of_class); });
        };
        techniques.connect = techniques.connect && all_fit();
        techniques.beams = techniques.beams && (techniques.connect || all_fit());
        return Schedule::by_class;
    }
    if (scene.features.bending) return Schedule::fused;
    size_t classes = 0;
    for (const auto& [interface, used] : scene.classes)
        if (interface != Interface::phase) classes += used.size();  // those are a line each
    return scene.triangles + scene.shapes <= 4096 && classes <= 8 ? Schedule::fused : Schedule::wavefront;
}

Renderer::Renderer(Device& device, Scene& scene, const RenderSettings& settings)
    : device_(device),
      scene_(scene),
      settings_(settings),
      schedule_(settings.schedule),
      views_(device, scene, all_views(settings)),
      light_layers_(device, scene, settings.layers),
      most_pixels_(views_.pixels()),
      counter_sums_(device, sizeof(CounterSums), "CounterSums"),
      receiver_moves_(scene.receiver_moves),
      spectra_(device, scene),
      commands_(device) {
    counter_sums_.fill(0);
    choice_ = {settings.algorithm, settings.forward_paths, "asked for", 0};
    if (settings.choice)
        choice_ = *settings.choice;
    else if (settings.algorithm == Algorithm::automatic)
        choice_ = choose_algorithm(device, scene, settings);
    settings_.algorithm = choice_.algorithm;
    settings_.forward_paths = choice_.forward_paths;
    settings_.stokes &= scene.features.polarization;
    Techniques techniques = choose_techniques(device, scene, settings_.algorithm);
    techniques.stokes = settings_.stokes;
    techniques.connect &= settings_.connect;
    techniques.beams &= settings_.beams;
    techniques.several_views = views_.count() > 1;
    techniques.ray_record = settings_.record_rays && techniques.forward &&
                            std::any_of(views_.all().begin(), views_.all().end(),
                                        [&](const FilmView& view) { return records_rays(scene, view); });
    techniques.light_layers = uint32_t(light_layers_.names().size());
    techniques.layer_defines = light_layers_.defines();
    if (settings_.stokes && !settings.layers.empty())
        fail_input("layers: images of Stokes vectors have none; --layers none leaves them out");
    film_ = std::make_unique<Film>(
        device, scene,
        FilmShape{uint32_t(most_pixels_), 1, techniques.merge, settings_.stokes, light_layers_.names()},
        timings_);
    if (!settings.restarts_first) film_->clear();
    BufferTable film = film_->buffers();
    film.merge(views_.buffers());
    film.merge(light_layers_.buffers());
    film["CounterSums"] = &counter_sums_;
    techniques.ledger = settings_.ledger && techniques.forward;
    if (techniques.ledger) {
        ledger_.emplace(device, scene);
        film.merge(ledger_->buffers());
    }
    scene.features.spectral_bins = scene.features.spectral ? settings.spectral_bins : 0;
    if (scene.features.spectral_bins > 0) {
        spectral_film_.emplace(device, uint32_t(most_pixels_), settings.spectral_bins, settings_.stokes);
        film.merge(spectral_film_->buffers());
    }
    if (schedule_ == Schedule::automatic)
        schedule_ = settings_.schedule = choose_schedule(device, scene, techniques);
    settings_.connect = techniques.connect;
    settings_.beams = techniques.beams;
    start_media_ = std::make_unique<StartMedia>(device, scene, views_, techniques.forward);
    start_media_->find();
    film["StartMedia"] = &start_media_->buffer();
    film.merge(spectra_.buffers());
    if (techniques.forward) {
        forward_ = std::make_unique<ForwardRays>(device, scene, settings_, techniques, film);
        film.merge(forward_->buffers());
    }
    if (schedule_ == Schedule::fused)
        pipeline_ = std::make_unique<FusedPipeline>(device, scene, settings_, techniques, forward_.get(),
                                                    spectra_, *film_, film);
    else
        pipeline_ =
            std::make_unique<WavefrontPipeline>(device, scene, settings_, techniques, forward_.get(),
                                                spectra_, *film_, film, schedule_ == Schedule::by_class);
    const auto start = std::chrono::steady_clock::now();
    compile_aside(device, newly_compiled(scene));
    if (forward_) forward_->warm_up(commands_);
    pipeline_->warm_up(commands_);
    film_->warm_up();
    warm_up_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Renderer::~Renderer() = default;

bool Renderer::render_passes(uint32_t count) {
    for (uint64_t left = count; left > 0;) {
        const PassRange range = passes_.next_missing(first_pass_, left);
        if (forward_ && forward_->find_fitting(commands_, range.first, spectra_, settings_.seed, timings_))
            clear_counter_sums();
        const auto start = std::chrono::steady_clock::now();
        if (!pipeline_->run(commands_, range.first, uint32_t(range.count()), timings_)) return false;
        passes_.add(range);
        read_counters();
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        seconds_ += seconds;
        last_pass_seconds_ = seconds / double(range.count());
        left -= range.count();
    }
    return true;
}

void Renderer::set_interrupt(std::function<bool()> interrupt) { pipeline_->interrupt = std::move(interrupt); }

void Renderer::restart(uint32_t seed) {
    restart(seed, {settings_.receiver, settings_.width, settings_.height});
}

void Renderer::restart(uint32_t seed, const FilmView& view) {
    std::vector<FilmView> views = views_.all();
    views[0] = view;
    if (pixel_count(views) > most_pixels_)
        fail_device("a film of {} x {} pixels is larger than the renderer was made for", view.width,
                    view.height);
    for (RenderSettings* settings : {&settings_, &pipeline_->settings}) {
        settings->seed = seed;
        settings->receiver = view.receiver;
        settings->width = view.width, settings->height = view.height;
    }
    if (views != views_.all() || receiver_moves_ != scene_.receiver_moves) {
        views_.set(views);
        start_media_->find_of_receivers();
    }
    receiver_moves_ = scene_.receiver_moves;
    film_->resize(uint32_t(views_.pixels()));
    if (spectral_film_) spectral_film_->resize(uint32_t(views_.pixels()));
    last_pass_seconds_ = 0;
    film_->clear();
    if (spectral_film_) spectral_film_->clear();
    clear_counter_sums();
    if (forward_) forward_->restart(settings_);
    counters_ = {};
    passes_ = {};
}

uint32_t Renderer::passes_in(double seconds) const {
    if (last_pass_seconds_ <= 0) return 1;
    return uint32_t(std::clamp(seconds / last_pass_seconds_, 1.0, 4096.0));
}

void Renderer::clear_counter_sums() {
    counter_sums_.fill(0);
    RenderCounters unused;
    if (ledger_) ledger_->take(unused.absorbed_by, unused.elements);
}

void Renderer::read_counters() {
    const CounterSums sums = counter_sums_.read_array<CounterSums>(1)[0];
    counter_sums_.fill(0);
    counters_.rays += sums.counts[0];
    counters_.shadow_rays += sums.counts[1];
    counters_.non_finite += sums.counts[2];
    counters_.depth_limit += sums.counts[3];
    counters_.escaped += sums.flux_sum(0);
    counters_.depth_limit_lost += sums.flux_sum(1);
    if (!forward_) return;
    counters_.forward_paths += forward_->take_paths();
    counters_.split_passes += forward_->take_splits();
    counters_.forward_paths_a_pass = forward_->paths_a_pass();
    counters_.forward_rays += sums.counts[4];
    counters_.forward_shadow_rays += sums.counts[5];
    counters_.forward_non_finite += sums.counts[6];
    counters_.forward_depth_limit += sums.counts[7];
    counters_.forward_escaped += sums.flux_sum(2);
    counters_.forward_depth_limit_lost += sums.flux_sum(3);
    counters_.emitted += sums.flux_sum(4);
    counters_.absorbed += sums.flux_sum(5);
    counters_.roulette += sums.flux_sum(6);
    if (ledger_) ledger_->take(counters_.absorbed_by, counters_.elements);
}

void Renderer::add_aovs(Image& image, uint32_t count, size_t view) {
    struct Aov {
        glm::vec3 albedo, normal;
        float depth;
    };
    const size_t pixels = pixel_count(image), band = std::min<size_t>(pixels, 1 << 20);  // fits in a binding
    const Buffer buffer(device_, band * sizeof(Aov), "Aovs");
    BufferTable table = views_.buffers();
    table.merge(BufferTable{{"Aovs", &buffer}, {"StartMedia", &start_media_->buffer()}});
    const Kernel kernel =
        make_color_kernel(device_, scene_, "kernels/trace_aovs.comp", table, views_.defines());
    std::vector<Aov> aovs;
    for (size_t first = 0; first < pixels; first += band) {
        const size_t count_here = std::min(band, pixels - first);
        commands_.dispatch(kernel, uint32_t((count_here + kernel.group_size() - 1) / kernel.group_size()),
                           {{"first_pixel", uint32_t(views_.first_pixel(view) + first)},
                            {"pixels", uint32_t(count_here)},
                            {"sample_count", count},
                            {"seed", settings_.seed}});
        commands_.run(&timings_);
        const auto part = buffer.read_array<Aov>(count_here);
        aovs.insert(aovs.end(), part.begin(), part.end());
    }
    add_channels(image, {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z"},
                 std::span(&aovs[0].albedo.x, 7 * pixels), 7);
}

void Renderer::read_picture(std::vector<glm::vec3>& picture) {
    if (!picture_) {
        picture_ = Buffer(device_, most_pixels_ * sizeof(glm::vec3), "Picture");
        BufferTable buffers = film_->buffers();
        buffers["Picture"] = &picture_;
        develop_film_ = make_color_kernel(device_, scene_, "kernels/develop_film.comp", buffers,
                                          film_->shape().defines());
    }
    film_->add_samples();
    const uint32_t pixels = settings_.width * settings_.height;
    const uint32_t size = develop_film_.group_size();
    commands_.dispatch(develop_film_, std::min((pixels + size - 1) / size, max_groups),
                       {{"pixels", pixels}, {"weight", passes() ? float(1.0 / double(passes())) : 0.0f}});
    commands_.run(&timings_);
    picture.resize(pixels);
    picture_.read(picture.data(), picture.size() * sizeof(glm::vec3));
}

std::vector<FilmView> all_views(const RenderSettings& settings) {
    std::vector<FilmView> views = {{settings.receiver, settings.width, settings.height}};
    views.insert(views.end(), settings.beside.begin(), settings.beside.end());
    return views;
}

void set_views(RenderSettings& settings, std::span<const FilmView> views) {
    const FilmView& first = views.front();
    settings.receiver = first.receiver, settings.width = first.width, settings.height = first.height;
    settings.beside.assign(views.begin() + 1, views.end());
}

FilmShape Renderer::film_shape(size_t view) const {
    FilmShape shape = film_->shape();
    shape.width = views()[view].width, shape.height = views()[view].height;
    return shape;
}

std::span<const ExactSum> Renderer::part(std::span<const ExactSum> sums, size_t view) const {
    const size_t stride = sums.size() / views_.pixels();
    return sums.subspan(views_.first_pixel(view) * stride, views()[view].pixels() * stride);
}

Image Renderer::develop(bool errors, size_t view) const {
    const std::vector<ExactSum> sums = film_->read();
    return develop_film(film_shape(view), part(sums, view), passes_, errors);
}

RelativeError Renderer::relative_error() const {
    const std::vector<ExactSum> sums = film_->read();
    RelativeError worst = film_relative_error(film_shape(0), part(sums, 0), passes_);
    for (size_t v = 1; v < views_.count(); ++v) {
        const RelativeError error = film_relative_error(film_shape(v), part(sums, v), passes_);
        if (!(error.value() <= worst.value())) worst = error;
    }
    return worst;
}

FilmState Renderer::state() const {
    return {film_->read(), passes_, counters_,
            spectral_film_ ? spectral_film_->read() : std::vector<ExactSum>()};
}

void Renderer::add_spectra(Image& image, size_t view) const {
    if (!spectral_film_) return;
    const std::vector<ExactSum> sums = spectral_film_->read();
    etendue::add_spectra(image, part(sums, view), settings_.spectral_bins, film_->shape().stokes_layers(),
                         passes());
}

CrossingSample Renderer::take_crossings(size_t view) {
    return forward_ ? forward_->take_crossings(view) : CrossingSample{};
}

void Renderer::restore(const FilmState& state) {
    film_->write(state.pixels);
    if (spectral_film_) spectral_film_->write(state.bins);
    passes_ = state.passes;
    counters_ = state.counters;
}

}  // namespace etendue
