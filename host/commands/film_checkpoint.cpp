#include "host/commands/film_checkpoint.h"

#include <algorithm>
#include <set>

#include "host/error.h"
#include "host/gltf/light_layers.h"
#include "host/image/atomic_file.h"
#include "host/image/polarization.h"

namespace etendue {
namespace {

const std::vector<std::string> seen_channels = {"albedo.R", "albedo.G", "albedo.B", "normal.X",
                                                "normal.Y", "normal.Z", "depth.Z"};

// Of each view.
FilmShape shape_of(const nlohmann::json& identity, size_t view) {
    FilmShape shape;
    const std::string size = identity.at("size").at(view);
    shape.width = uint32_t(std::stoul(size));
    shape.height = uint32_t(std::stoul(size.substr(size.find('x') + 1)));
    shape.merging = identity.at("merging");
    shape.stokes = identity.at("stokes");
    shape.light_layers = identity.at("layers").get<std::vector<std::string>>();
    return shape;
}

CheckpointArray array_of(const std::string& name, const std::vector<ExactSum>& sums) {
    const auto bytes = std::as_bytes(std::span(sums));
    return {name, {bytes.begin(), bytes.end()}};
}

std::span<ExactSum> sums_of(Checkpoint& checkpoint, const std::filesystem::path& path,
                            const std::string& name, uint64_t count) {
    auto& bytes = checkpoint_array(checkpoint, path, name, count * sizeof(ExactSum));
    return {reinterpret_cast<ExactSum*>(bytes.data()), count};
}

struct Sums {
    std::vector<FilmShape> views;
    uint32_t bins;
    std::span<ExactSum> film, spectra;
};
Sums sums_of(Checkpoint& checkpoint, const std::filesystem::path& path) {
    Sums sums{{}, checkpoint.identity.at("spectral-bins"), {}, {}};
    uint64_t film = 0, spectra = 0;
    for (size_t v = 0; v < checkpoint.identity.at("size").size(); ++v) {
        const FilmShape& shape = sums.views.emplace_back(shape_of(checkpoint.identity, v));
        film += shape.sums();
        if (sums.bins > 0) spectra += spectral_sums(shape.pixels(), sums.bins, shape.stokes_layers());
    }
    sums.film = sums_of(checkpoint, path, "film", film);
    if (sums.bins > 0) sums.spectra = sums_of(checkpoint, path, "bins", spectra);
    return sums;
}

std::string seen_name(size_t view) { return view == 0 ? "seen" : fmt::format("seen {}", view); }

nlohmann::json united(const nlohmann::json& a, const nlohmann::json& b) {
    std::set<std::string> all = a.get<std::set<std::string>>();
    all.merge(b.get<std::set<std::string>>());
    return all;
}

std::map<std::string, Attribute> attributes(const Checkpoint& checkpoint, size_t view) {
    std::string devices;
    for (const auto& device : checkpoint.about.at("devices"))
        devices += (devices.empty() ? "" : "; ") + device.get<std::string>();
    return {{"pixelUnit", checkpoint.identity.at("unit").at(view).get<std::string>()},
            {"receiver", checkpoint.identity.at("receiver").at(view).get<std::string>()},
            {"seed", checkpoint.identity.at("seed").get<double>()},
            {"passes", double(checkpoint.passes.count())},
            {"rays", double(all_rays(counters_from_json(checkpoint.about.at("counters"))))},
            {"seconds", checkpoint.about.at("seconds").get<double>()},
            {"algorithm", checkpoint.identity.at("algorithm").get<std::string>()},
            {"device", devices},
            {"version", std::string(ETENDUE_VERSION)}};
}

}  // namespace

nlohmann::json source_hashes(const OpenedScene& opened, const SceneChoice& choice) {
    uint64_t scene = hash_bytes({});
    for (const std::filesystem::path& file : opened.files) scene = hash_bytes(read_whole_file(file), scene);
    ShaderSources shaders{.folder = choice.shaders};
    shaders.keep_folder();
    return {{"version", ETENDUE_VERSION},
            {"scene", fmt::format("{:016x}", scene)},
            {"shaders", fmt::format("{:016x}", shaders.whole_hash().value_or(0))}};
}

nlohmann::json render_identity(const nlohmann::json& sources, const RenderOptions& options,
                               const Scene& scene, const std::vector<const Receiver*>& receivers,
                               const Renderer& renderer) {
    const AlgorithmChoice& choice = renderer.choice();
    const FilmShape shape = renderer.film_shape();
    const bool forward = choice.algorithm != Algorithm::backward;
    std::vector<std::string> names, sizes, units;
    for (size_t v = 0; v < receivers.size(); ++v) {
        const FilmView& view = renderer.views()[v];
        names.push_back(receivers[v]->name);
        sizes.push_back(fmt::format("{}x{}", view.width, view.height));
        units.push_back(receiver_unit(*receivers[v]));
    }
    nlohmann::json identity = sources;
    identity.update({{"receiver", names},
                     {"size", sizes},
                     {"unit", units},
                     {"seed", options.seed},
                     {"sampler", scene.features.independent_samples ? "independent" : "sobol"},
                     {"algorithm", algorithm_name(choice.algorithm)},
                     {"forward-paths", forward ? choice.forward_paths : 0.0},
                     {"vertex-memory", forward ? options.vertex_bytes >> 20 : 0},
                     {"color", scene.features.spectral ? "spectral" : "rgb"},
                     {"spectral-bins", scene.features.spectral_bins},
                     {"polarization", scene.features.polarization},
                     {"stokes", shape.stokes},
                     {"layers", shape.light_layers},
                     {"layer-conditions", to_json(renderer.layers())},
                     {"merging", shape.merging}});
    return identity;
}

std::string device_text(const Device& device) {
    return device.description.name + ", " + device.description.driver;
}

Checkpoint to_checkpoint(const nlohmann::json& identity, const Renderer& renderer, const Device& device,
                         const nlohmann::json& earlier) {
    const FilmState film = renderer.state();
    Checkpoint checkpoint;
    checkpoint.identity = identity;
    checkpoint.passes = film.passes;
    checkpoint.about = {{"counters", to_json(film.counters)},
                        {"choice", to_json(renderer.choice())},
                        {"devices", united(earlier.value("devices", nlohmann::json::array()),
                                           nlohmann::json::array({device_text(device)}))},
                        {"seconds", renderer.seconds() + earlier.value("seconds", 0.0)}};
    checkpoint.arrays.push_back(array_of("film", film.pixels));
    if (!film.bins.empty()) checkpoint.arrays.push_back(array_of("bins", film.bins));
    return checkpoint;
}

void restore(Checkpoint& checkpoint, const std::filesystem::path& path, Renderer& renderer) {
    const Sums sums = sums_of(checkpoint, path);
    renderer.restore({{sums.film.begin(), sums.film.end()},
                      checkpoint.passes,
                      counters_from_json(checkpoint.about.at("counters")),
                      {sums.spectra.begin(), sums.spectra.end()}});
}

void keep_seen(Checkpoint& checkpoint, const Image& image, size_t view) {
    if (find_channel(image, seen_channels[0]) < 0) return;
    CheckpointArray& array = checkpoint.arrays.emplace_back(CheckpointArray{seen_name(view), {}});
    for (const std::string& channel : seen_channels) {
        const auto bytes = std::as_bytes(plane(image, size_t(find_channel(image, channel))));
        array.bytes.insert(array.bytes.end(), bytes.begin(), bytes.end());
    }
}

void merge(Checkpoint& all, Checkpoint& part, const std::filesystem::path& path) {
    const Sums sums = sums_of(all, path), more = sums_of(part, path);
    merge(sums.film, more.film);
    merge(sums.spectra, more.spectra);
    all.passes.add(part.passes);
    RenderCounters counters = counters_from_json(all.about.at("counters"));
    add(counters, counters_from_json(part.about.at("counters")));
    all.about["counters"] = to_json(counters);
    all.about["devices"] = united(all.about.at("devices"), part.about.at("devices"));
    all.about["seconds"] = all.about.at("seconds").get<double>() + part.about.at("seconds").get<double>();
    for (CheckpointArray& array : part.arrays)
        if (std::none_of(all.arrays.begin(), all.arrays.end(),
                         [&](const CheckpointArray& other) { return other.name == array.name; }))
            all.arrays.push_back(std::move(array));  // what pixels see
}

std::vector<Developed> develop(Checkpoint& checkpoint, const std::filesystem::path& path, bool aovs) {
    const Sums sums = sums_of(checkpoint, path);
    std::vector<Developed> all;
    size_t film = 0, spectra = 0;
    for (size_t v = 0; v < sums.views.size(); ++v) {
        const FilmShape& shape = sums.views[v];
        const std::span<const ExactSum> pixels = sums.film.subspan(film, shape.sums());
        film += pixels.size();
        Developed& developed = all.emplace_back(Developed{
            checkpoint.identity.at("receiver").at(v), develop_film(shape, pixels, checkpoint.passes, aovs),
            film_relative_error(shape, pixels, checkpoint.passes)});
        Image& image = developed.image;
        for (const CheckpointArray& array : checkpoint.arrays)
            if (aovs && array.name == seen_name(v)) {
                const auto* first = reinterpret_cast<const float*>(array.bytes.data());
                for (size_t c = 0; c < seen_channels.size(); ++c)
                    add_channels(image, {seen_channels[c]},
                                 std::span(first + c * pixel_count(image), pixel_count(image)), 1);
            }
        if (aovs && has_stokes(image)) add_polarization(image);
        if (sums.bins > 0) {
            const uint64_t bins = spectral_sums(shape.pixels(), sums.bins, shape.stokes_layers());
            add_spectra(image, sums.spectra.subspan(spectra, bins), sums.bins, shape.stokes_layers(),
                        checkpoint.passes.count());
            spectra += bins;
        }
        image.attributes.merge(attributes(checkpoint, v));
    }
    return all;
}

}  // namespace etendue
