#include "host/measure/measurement.h"

#include <algorithm>
#include <chrono>

#include "host/measure/figures.h"
#include "host/render/automatic.h"

namespace etendue {
namespace {

// Fewer leave the device idle.
constexpr double least_forward_paths = 1 << 14;  // a pass
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
    std::vector<ExactSum> sums;
    RenderCounters counters;
};

}  // namespace

AlgorithmChoice choose_for_meter(Device& device, Scene& scene, const Receiver& receiver) {
    if (!receiver.info->is_far)
        if (const auto choice = choose_without_pilot(device, scene)) return *choice;
    AlgorithmChoice choice;
    choice.algorithm = Algorithm::bidirectional;
    const double pixels = double(receiver.columns) * receiver.rows;
    choice.forward_paths = std::max(1.0, least_forward_paths / pixels);
    choice.reason = receiver.info->is_far ? "points and beams reach meters far away by forward rays alone"
                                          : "backward rays alone may miss light";
    return choice;
}

MeasurementRun::MeasurementRun(Device& device, Scene& scene, const std::vector<const Receiver*>& receivers,
                               const RenderSettings& common)
    : device_(device), scene_(scene), settings_(common) {
    measurement_.power = scene.power;
    for (const Receiver* receiver : receivers) {
        RenderSettings settings = common;
        settings.width = receiver->columns, settings.height = receiver->rows;
        settings.receiver = receiver->ref;
        settings.vertex_bytes = common.vertex_bytes / receivers.size();
        if (settings.algorithm == Algorithm::automatic)
            settings.choice = choose_for_meter(device, scene, *receiver);
        renderers_.push_back(std::make_unique<Renderer>(device, scene, settings));
        views_.push_back({receiver->ref, settings.width, settings.height});
        Readings readings;
        readings.meter = describe_meter(device, scene, *receiver);
        readings.sums.resize(readings.meter.pixels() * replicates);
        readings.choice = renderers_.back()->choice();
        measurement_.meters.push_back(std::move(readings));
    }
}

MeasurementRun::~MeasurementRun() = default;

bool MeasurementRun::add(const PassRange& range, const std::function<bool()>& interrupt) {
    const auto start = std::chrono::steady_clock::now();
    const uint64_t first = range.first / replicates, count = range.count() / replicates;
    std::vector<Addend> addends;
    for (size_t m = 0; m < renderers_.size(); ++m) {
        Addend& addend = addends.emplace_back();
        addend.sums.resize(measurement_.meters[m].sums.size());
        for (uint32_t k = 0; k < replicates; ++k) {
            if (interrupt()) return false;
            Renderer& renderer = *renderers_[m];
            renderer.restart(seed_of(settings_.seed, k), views_[m]);
            renderer.begin_at(first);
            renderer.render_passes(uint32_t(count));
            const FilmState film = renderer.state();
            const FilmShape& shape = renderer.film_shape();
            const size_t half = shape.sums_a_layer() / 2, stride = 2 * half * shape.layers();
            for (size_t i = 0; i * stride < film.pixels.size(); ++i)
                for (size_t at : {i * stride, i * stride + half})
                    merge(addend.sums[i * replicates + k], film.pixels[at]);
            etendue::add(addend.counters, film.counters);
        }
    }
    measurement_.passes.add(range);
    for (size_t m = 0; m < addends.size(); ++m) {
        Readings& readings = measurement_.meters[m];
        merge(std::span(readings.sums), std::span<const ExactSum>(addends[m].sums));
        etendue::add(readings.counters, addends[m].counters);
        readings.passes = measurement_.passes.count() / replicates;
    }
    measurement_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return true;
}

std::vector<std::string> MeasurementRun::probe_dark_meters() {
    std::vector<std::string> reached;
    for (size_t m = 0; m < views_.size(); ++m) {
        Readings& readings = measurement_.meters[m];
        if (!is_dark(readings) || readings.counters.forward_paths > 0 || !(scene_.power > 0)) continue;
        RenderSettings settings = settings_;
        settings.algorithm = Algorithm::forward;
        settings.receiver = views_[m].receiver;
        settings.width = views_[m].width, settings.height = views_[m].height;
        settings.forward_paths = std::max(1.0, probing_paths / double(readings.meter.pixels()));
        Renderer renderer(device_, scene_, settings);
        renderer.render_passes(1);
        const Image image = renderer.develop(false);
        const auto is_lit = [](float x) { return x != 0; };
        if (std::any_of(image.values.begin(), image.values.end(), is_lit))
            reached.push_back(readings.meter.name);
        else
            readings.probing_paths = renderer.counters().forward_paths;
    }
    return reached;
}

uint64_t MeasurementRun::rays() const {
    uint64_t rays = 0;
    for (const Readings& readings : measurement_.meters) rays += all_rays(readings.counters);
    return rays;
}

}  // namespace etendue
