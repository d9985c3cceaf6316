#include "host/measure/measurement.h"

#include <algorithm>
#include <chrono>

#include "host/measure/figures.h"
#include "host/render/automatic.h"

namespace etendue {
namespace {

// That none of which arrives says: less than 3 in a million do.
constexpr double probing_paths = 1 << 20;

// Seeds of replicates, and of neighbouring seeds, have nothing in common (finalizer of MurmurHash3).
uint32_t seed_of(uint32_t seed, uint32_t replicate) {
    uint32_t h = seed * replicates + replicate + 0x9E3779B9u;
    h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u;
    return h ^ (h >> 16);
}

// What one meter reads in the passes that are being made.
struct Addend {
    std::vector<ExactSum> sums, spectra, row_spectra;
    std::vector<std::vector<ExactSum>> layers;
    explicit Addend(const Readings& readings)
        : sums(readings.sums.size()),
          spectra(readings.spectra.size()),
          row_spectra(readings.row_spectra.size()),
          layers(readings.layers.size(), std::vector<ExactSum>(sums.size())) {}
};

// Renders meters, as many at once as one renderer serves.
std::vector<RenderSettings> settings_of(const RenderSettings& common, const std::vector<FilmView>& views) {
    std::vector<RenderSettings> all;
    for (size_t first = 0; first < views.size(); first += most_views) {
        const size_t count = std::min(most_views, views.size() - first);
        set_views(all.emplace_back(common), std::span(views).subspan(first, count));
    }
    for (RenderSettings& settings : all) settings.vertex_bytes = common.vertex_bytes / all.size();
    return all;
}

}  // namespace

MeasurementRun::MeasurementRun(Device& device, Scene& scene, const std::vector<const Receiver*>& receivers,
                               const RenderSettings& common)
    : device_(device), scene_(scene), settings_(common) {
    settings_.ledger = true;
    measurement_.power = scene.power;
    settings_.record_rays = true;
    std::vector<FilmView> views;
    for (const Receiver* receiver : receivers) {
        views.push_back({receiver->ref, receiver->columns, receiver->rows});
        Readings& readings = measurement_.meters.emplace_back();
        readings.rays = crossing_sample(scene, views.back());
        readings.meter = describe_meter(device, scene, *receiver);
        readings.sums.resize(readings.meter.pixels() * replicates);
        readings.spectral_bins = scene.features.spectral ? common.spectral_bins : 0;
        readings.spectra.resize(spectral_sums(readings.meter.pixels(), readings.spectral_bins, 1));
        readings.row_spectra.resize(
            spectral_sums(uint64_t(readings.meter.rows) * replicates, readings.spectral_bins, 1));
    }
    if (settings_.algorithm == Algorithm::automatic) {
        const auto sure = choose_without_pilot(device, scene, views);
        settings_.choice = sure ? *sure : choose_both_ways(views, "backward rays alone may miss light");
    }
    for (const RenderSettings& settings : settings_of(settings_, views))
        renderers_.push_back(std::make_unique<Renderer>(device, scene, settings));
    measurement_.choice = renderers_.front()->choice();
    for (Readings& readings : measurement_.meters)
        for (const std::string& name : renderers_.front()->film_shape().light_layers)
            readings.layers.push_back({name, std::vector<ExactSum>(readings.sums.size())});
}

MeasurementRun::~MeasurementRun() = default;

bool MeasurementRun::add(const PassRange& range, const std::function<bool()>& interrupt) {
    const auto start = std::chrono::steady_clock::now();
    const uint64_t first = range.first / replicates, count = range.count() / replicates;
    std::vector<Addend> addends;
    for (const Readings& readings : measurement_.meters) addends.emplace_back(readings);
    RenderCounters counters;
    for (uint32_t k = 0; k < replicates; ++k) {
        size_t meter = 0;
        for (const auto& renderer : renderers_) {
            if (interrupt()) return false;
            renderer->restart(seed_of(settings_.seed, k));
            renderer->begin_at(first);
            renderer->render_passes(uint32_t(count));
            const FilmState film = renderer->state();
            etendue::add(counters, film.counters);
            const FilmShape shape = renderer->film_shape();
            const size_t half = shape.sums_a_layer() / 2, stride = shape.sums_a_pixel();
            const ExactSum* pixel = film.pixels.data();
            const ExactSum* bins = film.bins.data();
            for (size_t v = 0; v < renderer->views().size(); ++v, ++meter) {
                Addend& addend = addends[meter];
                const Readings& readings = measurement_.meters[meter];
                for (size_t i = 0; i < readings.meter.pixels(); ++i, pixel += stride)
                    for (size_t at : {size_t(0), half}) {
                        merge(addend.sums[i * replicates + k], pixel[at]);
                        for (size_t layer = 0; layer < addend.layers.size(); ++layer)
                            merge(addend.layers[layer][i * replicates + k],
                                  pixel[(layer + 1) * 2 * half + at]);
                    }
                const size_t triples = spectral_sums(1, readings.spectral_bins, 1);
                for (size_t i = 0; i < addend.spectra.size(); ++i, ++bins) {
                    const size_t row = i / triples / readings.meter.columns;
                    merge(addend.spectra[i], *bins);
                    merge(addend.row_spectra[(row * replicates + k) * triples + i % triples], *bins);
                }
            }
        }
    }
    measurement_.passes.add(range);
    etendue::add(measurement_.counters, counters);
    for (size_t m = 0; m < addends.size(); ++m) {
        Readings& readings = measurement_.meters[m];
        merge(std::span(readings.sums), std::span<const ExactSum>(addends[m].sums));
        merge(std::span(readings.spectra), std::span<const ExactSum>(addends[m].spectra));
        merge(std::span(readings.row_spectra), std::span<const ExactSum>(addends[m].row_spectra));
        for (size_t layer = 0; layer < readings.layers.size(); ++layer)
            merge(std::span(readings.layers[layer].sums),
                  std::span<const ExactSum>(addends[m].layers[layer]));
        readings.passes = measurement_.passes.count() / replicates;
        readings.forward_paths += counters.forward_paths / renderers_.size();
    }
    auto readings = measurement_.meters.begin();
    for (const auto& renderer : renderers_)
        for (size_t v = 0; v < renderer->views().size(); ++v, ++readings) {
            const CrossingSample rays = renderer->take_crossings(v);
            readings->rays.add(rays.crossings, rays.greatest_key);
        }
    measurement_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return true;
}

std::vector<std::string> MeasurementRun::probe_dark_meters() {
    std::vector<FilmView> dark_views;
    std::vector<Readings*> dark;
    size_t meter = 0;
    for (const auto& renderer : renderers_)
        for (const FilmView& view : renderer->views()) {
            Readings& readings = measurement_.meters[meter++];
            if (!is_dark(readings) || readings.forward_paths > 0 || !(scene_.power > 0)) continue;
            dark_views.push_back(view);
            dark.push_back(&readings);
        }
    RenderSettings common = settings_;
    common.choice.reset();
    common.layers.clear();
    common.ledger = false;
    common.algorithm = Algorithm::forward;
    std::vector<std::string> reached;
    auto readings = dark.begin();
    for (RenderSettings& settings : settings_of(common, dark_views)) {
        settings.forward_paths = std::max(1.0, probing_paths / double(pixel_count(all_views(settings))));
        Renderer renderer(device_, scene_, settings);
        renderer.render_passes(1);
        for (size_t v = 0; v < renderer.views().size(); ++v, ++readings) {
            const Image image = renderer.develop(false, v);
            const auto is_lit = [](float x) { return x != 0; };
            if (std::any_of(image.values.begin(), image.values.end(), is_lit))
                reached.push_back((*readings)->meter.name);
            else
                (*readings)->probing_paths = renderer.counters().forward_paths;
        }
    }
    return reached;
}

}  // namespace etendue
