// etendue render: a scene to an image, until a number of passes, a time or an error is reached.
#include <chrono>
#include <fstream>
#include <glm/glm.hpp>
#include <thread>

#include "host/commands/choose_meanwhile.h"
#include "host/commands/stats.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/checkpoint.h"
#include "host/image/exr.h"
#include "host/image/image.h"
#include "host/image/polarization.h"
#include "host/interrupt.h"
#include "host/open_scene.h"
#include "host/progress.h"
#include "host/render/renderer.h"

namespace etendue {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double batch_seconds = 0.25;     // of work between two looks at clock, interrupt and progress
constexpr double checkpoint_seconds = 30;  // between two checkpoints
constexpr uint32_t aov_samples = 16;       // primary rays a pixel for --aovs

// Of everything that the device holds of the scene and of what it compiles, whichever files that came from.
uint64_t scene_hash(const Scene& scene) {
    uint64_t hash = hash_bytes({});
    for (const auto& [name, buffer] : scene.buffers)
        hash = hash_bytes(buffer.read_array<std::byte>(buffer.bytes()), hash);
    for (const auto& [name, buffer] : scene.shared_buffers)
        hash = hash_bytes(buffer->read_array<std::byte>(buffer->bytes()), hash);
    for (const SpectralTable& spectrum : scene.spectra)
        hash = hash_bytes(std::as_bytes(std::span(spectrum.values)), hash);
    for (const auto& [name, text] : scene.sources.generated)
        hash = hash_bytes(std::as_bytes(std::span(text)), hash);
    return hash;
}

// What a checkpoint must agree on to be gone on from.
nlohmann::json checkpoint_identity(const RenderOptions& options, const Scene& scene, const ImageSize& size,
                                   const Receiver& receiver, const Device& device) {
    return {{"version", ETENDUE_VERSION},
            {"scene", fmt::format("{:016x}", scene_hash(scene))},
            {"size", fmt::format("{}x{}", size.width, size.height)},
            {"receiver", receiver.name},
            {"seed", options.seed},
            {"sampler", scene.features.independent_samples ? "independent" : "sobol"},
            {"algorithm", algorithm_name(options.algorithm)},
            {"color", scene.features.spectral ? "spectral" : "rgb"},
            {"spectral-bins", options.spectral_bins},
            {"polarization", scene.features.polarization},
            {"device", device.description.name + " " + device.description.driver}};
}

void save_checkpoint(const std::filesystem::path& path, const nlohmann::json& identity,
                     const Renderer& renderer) {
    FilmState film = renderer.state();
    Checkpoint checkpoint;
    checkpoint.identity = identity;
    checkpoint.passes = film.passes;
    checkpoint.counters = to_json(film.counters);
    checkpoint.counters["choice"] = to_json(renderer.choice());
    checkpoint.arrays.push_back({"film", std::move(film.pixels)});
    if (!film.bins.empty()) checkpoint.arrays.push_back({"bins", std::move(film.bins)});
    write_checkpoint(path, checkpoint);
}

void restore(const Checkpoint& checkpoint, const std::filesystem::path& path, Renderer& renderer) {
    FilmState film = renderer.state();
    film.pixels = checkpoint_array(checkpoint, path, "film", film.pixels.size());
    if (!film.bins.empty()) film.bins = checkpoint_array(checkpoint, path, "bins", film.bins.size());
    film.passes = checkpoint.passes;
    film.counters = counters_from_json(checkpoint.counters);
    renderer.restore(film);
}

}  // namespace

int render_command(const RenderOptions& given) {
    RenderOptions options = given;
    for (const auto& path : {options.output, options.stats, options.checkpoint})
        if (!path.empty()) check_writable(path);
    catch_interrupts();
    Progress progress;
    progress.style = progress_style(options.quiet);

    const auto start = Clock::now();
    OpenedScene opened = open_scene(options);
    Device& device = *opened.device;
    Scene& scene = opened.scene;
    for (const std::string& warning : scene.warnings) show_note(progress, "warning: " + warning);
    const Receiver& receiver = choose_receiver(scene, options);
    if (scene.lights == 0)
        show_note(progress, fmt::format("warning: {}: the scene has no light: the image is black",
                                        options.scene.string()));
    if (receiver.wants_stokes && !scene.features.polarization)
        show_note(progress,
                  fmt::format("warning: {} asks for Stokes vectors: without polarization there are none",
                              receiver.name));
    options.size = image_size(receiver, options);

    RenderSettings settings;
    settings.width = options.size->width, settings.height = options.size->height;
    settings.receiver = receiver.ref;
    settings.algorithm = options.algorithm;
    settings.schedule = options.schedule;
    settings.vertex_bytes = options.vertex_bytes;
    settings.spectral_bins = options.spectral_bins;
    settings.stokes = receiver.wants_stokes;
    settings.seed = uint32_t(options.seed ^ (options.seed >> 32));
    nlohmann::json identity;
    if (!options.checkpoint.empty() || !options.resume.empty())
        identity = checkpoint_identity(options, scene, *options.size, receiver, device);
    std::optional<Checkpoint> resumed;
    if (!options.resume.empty()) {
        resumed = read_checkpoint(options.resume, identity);
        const AlgorithmChoice choice = choice_from_json(resumed->counters.at("choice"));
        if (!choice.is_open) settings.choice = choice;  // else the pilot had not told when it was written
    }
    ChooseMeanwhile chooses(device, scene, options, settings, receiver);
    std::unique_ptr<Renderer> renderer = chooses.make_renderer();
    if (resumed) restore(*resumed, options.resume, *renderer);
    if (const std::string& note = chooses.note(); !note.empty()) show_note(progress, note);
    const double setup_seconds = seconds_since(start);

    RenderStatus status;
    status.passes_goal = options.passes, status.seconds_goal = options.seconds,
    status.error_goal = options.error;
    status.passes_before = renderer->passes();
    uint64_t rays_before = all_rays(renderer->counters());
    auto render_start = Clock::now();
    double next_checkpoint = checkpoint_seconds;
    ErrorGoal error_goal{options.error.value_or(0)};
    bool accurate = false;
    bool done = options.passes && renderer->passes() >= *options.passes;
    while ((!done || chooses.is_open()) && !interrupted()) {
        if (chooses.has_chosen()) {  // the two ways are not mixed: backward rays alone may have missed light
            if (chooses.take()) {
                renderer.reset();  // two may not fit
                renderer = chooses.make_renderer();
                status.passes_before = rays_before = 0;
                render_start = Clock::now();
                next_checkpoint = checkpoint_seconds;
                error_goal = ErrorGoal{options.error.value_or(0)};
                status.seconds = 0;
                status.error.reset();
                accurate = done = false;
            } else {
                renderer->explain(chooses.choice());
            }
            show_note(progress, chooses.note());
            continue;
        }
        if (done) {
            const double late = seconds_since(render_start) - options.seconds.value_or(1e9);
            if (late > 0.1 * options.seconds.value_or(1e9)) {
                chooses.give_up();
                renderer->explain(chooses.choice());
                show_note(progress, chooses.note());
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            continue;
        }
        double batch = batch_seconds;
        if (options.seconds) batch = std::min(batch, *options.seconds - status.seconds);
        uint32_t count = renderer->passes_in(batch);
        if (options.passes) count = uint32_t(std::min<uint64_t>(count, *options.passes - renderer->passes()));
        renderer->render_passes(count);
        status.passes = renderer->passes();
        status.seconds = seconds_since(render_start);
        status.rays = double(all_rays(renderer->counters()) - rays_before);
        if (options.error && error_goal.is_due(renderer->passes())) {
            const RelativeError error = renderer->relative_error();
            status.error = error.value();
            accurate = error_goal.look(renderer->passes(), error);
        }
        done = (options.passes && renderer->passes() >= *options.passes) ||
               (options.seconds && status.seconds >= *options.seconds) || accurate;
        if (!options.checkpoint.empty() && !chooses.is_open() && status.seconds >= next_checkpoint) {
            save_checkpoint(options.checkpoint, identity, *renderer);
            next_checkpoint = seconds_since(render_start) + checkpoint_seconds;
        }
        show_progress(progress, status);
    }
    finish_progress(progress, status);
    if (!options.checkpoint.empty()) save_checkpoint(options.checkpoint, identity, *renderer);

    Image image = renderer->develop(options.aovs);
    const RelativeError error = renderer->relative_error();
    const std::string& unit = receiver.info->pixel_unit;  // empty: of a camera, which sees things
    if (options.aovs && unit.empty()) renderer->add_aovs(image, aov_samples);
    image.attributes["pixelUnit"] = unit.empty() ? std::string("cd/m²") : unit;
    if (options.aovs && has_stokes(image)) add_polarization(image);
    renderer->add_spectra(image);
    image.attributes.merge(std::map<std::string, Attribute>{
        {"scene", options.scene.string()},
        {"command", options.command_line},
        {"seed", double(options.seed)},
        {"passes", double(renderer->passes())},
        {"rays", double(all_rays(renderer->counters()))},
        {"seconds", renderer->seconds()},
        {"algorithm", std::string(algorithm_name(renderer->choice().algorithm))},
        {"device", device.description.name},
        {"driver", device.description.driver},
        {"version", std::string(ETENDUE_VERSION)}});
    write_exr(options.output, image);
    if (!options.stats.empty())
        write_stats(options.stats, options, device, scene, *renderer, error, setup_seconds);
    if (renderer->counters().non_finite)
        show_note(progress, fmt::format("warning: {} samples were not finite and count as black",
                                        renderer->counters().non_finite));
    if (renderer->counters().depth_limit)
        show_note(progress, fmt::format("warning: {} paths were cut at the depth limit",
                                        renderer->counters().depth_limit));
    return int(interrupted() && !done ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace etendue
