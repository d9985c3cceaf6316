#include "host/commands/measure_checkpoint.h"

#include <cstring>
#include <set>

#include "host/error.h"
#include "host/gltf/light_layers.h"

namespace etendue {
namespace {

template <class T>
std::vector<T> array_of(Checkpoint& checkpoint, const std::filesystem::path& path, const std::string& name,
                        size_t count) {
    const auto& bytes = checkpoint_array(checkpoint, path, name, count * sizeof(T));
    std::vector<T> values(count);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

template <class T>
void add_array(Checkpoint& checkpoint, const std::string& name, const std::vector<T>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    checkpoint.arrays.push_back({name, {bytes.begin(), bytes.end()}});
}

std::string array_name(size_t meter, const char* what) { return fmt::format("{} of meter {}", what, meter); }

std::string layer_sums(const std::string& layer) { return fmt::format("sums of {}", layer); }

// What changes with the passes.
void keep(const Measurement& measurement, Checkpoint& checkpoint) {
    nlohmann::json meters = nlohmann::json::array();
    checkpoint.arrays.clear();
    for (size_t m = 0; m < measurement.meters.size(); ++m) {
        const Readings& readings = measurement.meters[m];
        meters.push_back({{"name", readings.meter.name},
                          {"unit", readings.meter.unit},
                          {"columns", readings.meter.columns},
                          {"rows", readings.meter.rows},
                          {"is_far", readings.meter.is_far},
                          {"has_extent", readings.meter.has_extent},
                          {"triangles", readings.meter.triangles},
                          {"spectral_bins", readings.spectral_bins},
                          {"forward_paths", readings.forward_paths},
                          {"most_crossings", readings.rays.most},
                          {"greatest_key", readings.rays.greatest_key},
                          {"crossings", readings.rays.crossings.size()},
                          {"probing_paths", readings.probing_paths}});
        add_array(checkpoint, array_name(m, "sums"), readings.sums);
        meters.back()["layers"] = nlohmann::json::array();
        for (const LayerReadings& layer : readings.layers) {
            meters.back()["layers"].push_back(layer.name);
            add_array(checkpoint, array_name(m, layer_sums(layer.name).c_str()), layer.sums);
        }
        add_array(checkpoint, array_name(m, "places"), readings.meter.places);
        add_array(checkpoint, array_name(m, "spectra"), readings.spectra);
        add_array(checkpoint, array_name(m, "spectra of rows"), readings.row_spectra);
        add_array(checkpoint, array_name(m, "crossings"), readings.rays.crossings);
    }
    checkpoint.passes = measurement.passes;
    checkpoint.about["meters"] = meters;
    checkpoint.about["counters"] = to_json(measurement.counters);
    checkpoint.about["choice"] = to_json(measurement.choice);
    checkpoint.about["seconds"] = measurement.seconds;
    checkpoint.about["power"] = measurement.power;
}

}  // namespace

nlohmann::json measurement_identity(const nlohmann::json& sources, const MeasureOptions& options,
                                    const Scene& scene, const MeasurementRun& run) {
    nlohmann::json meters = nlohmann::json::array();
    for (const Readings& readings : run.measurement().meters) {
        meters.push_back({{"name", readings.meter.name},
                          {"size", fmt::format("{}x{}", readings.meter.columns, readings.meter.rows)}});
    }
    nlohmann::json identity = sources;
    const AlgorithmChoice& choice = run.measurement().choice;
    identity.update({{"meters", meters},
                     {"algorithm", algorithm_name(choice.algorithm)},
                     {"forward-paths", choice.algorithm == Algorithm::backward ? 0.0 : choice.forward_paths},
                     {"replicates", replicates},
                     {"seed", options.seed},
                     {"sampler", scene.features.independent_samples ? "independent" : "sobol"},
                     {"vertex-memory", options.vertex_bytes >> 20},
                     {"layer-conditions", to_json(run.layers())},
                     {"color", scene.features.spectral ? "spectral" : "rgb"},
                     {"spectral-bins", scene.features.spectral_bins},
                     {"polarization", scene.features.polarization}});
    return identity;
}

bool is_measurement(const Checkpoint& checkpoint) { return checkpoint.identity.contains("replicates"); }

Checkpoint to_checkpoint(const nlohmann::json& identity, const Measurement& measurement,
                         const std::vector<std::string>& devices, const MeasureOptions& options) {
    Checkpoint checkpoint;
    checkpoint.identity = identity;
    checkpoint.about = {
        {"scene", options.scene.string()}, {"points", nlohmann::json::array()}, {"devices", devices}};
    checkpoint.about["glare_from"] = options.glare_from.value_or(usual_glare_from);
    for (const glm::dvec2& point : options.points) checkpoint.about["points"].push_back({point.x, point.y});
    keep(measurement, checkpoint);
    return checkpoint;
}

Measurement measurement_of(Checkpoint& checkpoint, const std::filesystem::path& path) {
    Measurement measurement;
    measurement.passes = checkpoint.passes;
    measurement.seconds = checkpoint.about.at("seconds");
    measurement.power = checkpoint.about.at("power");
    measurement.counters = counters_from_json(checkpoint.about.at("counters"));
    measurement.choice = choice_from_json(checkpoint.about.at("choice"));
    for (const nlohmann::json& json : checkpoint.about.at("meters")) {
        const size_t m = measurement.meters.size();
        Readings& readings = measurement.meters.emplace_back();
        Meter& meter = readings.meter;
        meter.name = json.at("name"), meter.unit = json.at("unit");
        meter.columns = json.at("columns"), meter.rows = json.at("rows");
        meter.is_far = json.at("is_far"), meter.has_extent = json.at("has_extent");
        meter.triangles = json.at("triangles");
        meter.places = array_of<PixelPlace>(checkpoint, path, array_name(m, "places"), meter.pixels());
        readings.sums =
            array_of<ExactSum>(checkpoint, path, array_name(m, "sums"), meter.pixels() * replicates);
        for (const std::string name : json.at("layers"))
            readings.layers.push_back(
                {name, array_of<ExactSum>(checkpoint, path, array_name(m, layer_sums(name).c_str()),
                                          meter.pixels() * replicates)});
        readings.spectral_bins = json.at("spectral_bins");
        readings.spectra = array_of<ExactSum>(checkpoint, path, array_name(m, "spectra"),
                                              spectral_sums(meter.pixels(), readings.spectral_bins, 1));
        readings.row_spectra =
            array_of<ExactSum>(checkpoint, path, array_name(m, "spectra of rows"),
                               spectral_sums(meter.rows * replicates, readings.spectral_bins, 1));
        readings.rays = {json.at("most_crossings"), json.at("greatest_key"), {}};
        readings.rays.crossings = array_of<RayCrossing>(checkpoint, path, array_name(m, "crossings"),
                                                        json.at("crossings").get<size_t>());
        readings.forward_paths = json.at("forward_paths");
        readings.probing_paths = json.at("probing_paths");
        readings.passes = checkpoint.passes.count() / replicates;
    }
    return measurement;
}

void add(Measurement& all, const Measurement& part) {
    all.passes.add(part.passes);
    all.seconds += part.seconds;
    add(all.counters, part.counters);
    for (size_t m = 0; m < all.meters.size(); ++m) {
        Readings& readings = all.meters[m];
        merge(std::span(readings.sums), std::span<const ExactSum>(part.meters[m].sums));
        for (size_t layer = 0; layer < readings.layers.size(); ++layer)
            merge(std::span(readings.layers[layer].sums),
                  std::span<const ExactSum>(part.meters[m].layers[layer].sums));
        merge(std::span(readings.spectra), std::span<const ExactSum>(part.meters[m].spectra));
        merge(std::span(readings.row_spectra), std::span<const ExactSum>(part.meters[m].row_spectra));
        readings.rays.add(part.meters[m].rays.crossings, part.meters[m].rays.greatest_key);
        readings.forward_paths += part.meters[m].forward_paths;
        readings.probing_paths = std::max(readings.probing_paths, part.meters[m].probing_paths);
        readings.passes = all.passes.count() / replicates;
    }
}

void merge_measurement(Checkpoint& all, Checkpoint& part, const std::filesystem::path& path) {
    Measurement sum = measurement_of(all, path);
    add(sum, measurement_of(part, path));
    keep(sum, all);
    std::set<std::string> devices = all.about.at("devices");
    devices.merge(part.about.at("devices").get<std::set<std::string>>());
    all.about["devices"] = devices;
}

ReportOptions report_options(const Checkpoint& checkpoint, const std::filesystem::path& folder,
                             const std::string& command_line) {
    ReportOptions options{.folder = folder, .glare_from = checkpoint.about.at("glare_from")};
    for (const nlohmann::json& point : checkpoint.about.at("points"))
        options.points.push_back({point.at(0), point.at(1)});
    std::string devices;
    for (const std::string device : checkpoint.about.at("devices"))
        devices += (devices.empty() ? "" : "; ") + device;
    options.attributes = {{"scene", checkpoint.about.at("scene").get<std::string>()},
                          {"command", command_line},
                          {"seed", checkpoint.identity.at("seed").get<double>()},
                          {"passes", double(checkpoint.passes.count())},
                          {"seconds", checkpoint.about.at("seconds").get<double>()},
                          {"device", devices},
                          {"version", std::string(ETENDUE_VERSION)}};
    return options;
}

}  // namespace etendue
