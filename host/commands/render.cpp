// etendue render: a scene to an image, until a number of passes, a time or an error is reached.
#include <chrono>
#include <fstream>
#include <glm/glm.hpp>
#include <thread>

#include "host/commands/choose_meanwhile.h"
#include "host/commands/film_checkpoint.h"
#include "host/commands/stats.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/image.h"
#include "host/image/outputs.h"
#include "host/image/polarization.h"
#include "host/interrupt.h"
#include "host/progress.h"
#include "host/render/automatic.h"
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

// Checkpoints of one run: what its passes belong to, and those that it went on from.
class Checkpoints {
  public:
    Checkpoints(const RenderOptions& options, const OpenedScene& opened,
                const std::vector<const Receiver*>& receivers)
        : options_(options), opened_(opened), receivers_(receivers) {
        if (options.checkpoint.empty() && options.resume.empty()) return;
        sources_ = source_hashes(opened, options);
        if (!options.resume.empty()) resumed_ = read_checkpoint(options.resume);
    }
    // That the earlier passes were made by, where it was settled and none is asked for.
    std::optional<AlgorithmChoice> choice() const {
        std::optional<AlgorithmChoice> choice;
        if (resumed_ && options_.algorithm == Algorithm::automatic)
            choice = choice_from_json(resumed_->about.at("choice"));
        if (choice && choice->is_open) choice.reset();  // the pilot had not told when it was written
        return choice;
    }
    // A line for the user; may be empty.
    std::string restore(Renderer& renderer) {
        if (!resumed_) return "";
        require_identity(options_.resume, resumed_->identity, identity(renderer), "now");
        etendue::restore(*resumed_, options_.resume, renderer);
        about_ = resumed_->about;
        resumed_.reset();
        const nlohmann::json here = {device_text(*opened_.device)};
        return about_.at("devices") == here
                   ? ""
                   : fmt::format("{}: passes of {}: what devices make agrees within rounding",
                                 options_.resume.string(), about_.at("devices").dump());
    }
    void drop_earlier() { about_ = nlohmann::json::object(); }
    // `images`: of the views, some with the layers of what pixels see.
    void save(const Renderer& renderer, const std::vector<Image>& images = {}) const {
        if (options_.checkpoint.empty()) return;
        Checkpoint checkpoint = to_checkpoint(identity(renderer), renderer, *opened_.device, about_);
        for (size_t v = 0; v < images.size(); ++v) keep_seen(checkpoint, images[v], v);
        write_checkpoint(options_.checkpoint, checkpoint);
    }

  private:
    nlohmann::json identity(const Renderer& renderer) const {
        return render_identity(sources_, options_, opened_.scene, receivers_, renderer);
    }
    const RenderOptions& options_;
    const OpenedScene& opened_;
    const std::vector<const Receiver*>& receivers_;
    nlohmann::json sources_, about_ = nlohmann::json::object();
    std::optional<Checkpoint> resumed_;
};

// Passes that were asked for and are not there.
uint64_t passes_left(const RenderOptions& options, const Renderer& renderer) {
    uint64_t left = 0;
    if (options.passes)
        for (const PassRange& range :
             renderer.pass_set().missing(options.first_pass, options.first_pass + *options.passes))
            left += range.count();
    return left;
}

}  // namespace

int render_command(const RenderOptions& options) {
    for (const auto& path : {options.stats, options.checkpoint})
        if (!path.empty()) check_writable(path);
    catch_interrupts();
    Progress progress;
    progress.style = progress_style(options.quiet);

    const auto start = Clock::now();
    OpenedScene opened = open_scene(options);
    Device& device = *opened.device;
    Scene& scene = opened.scene;
    for (const std::string& warning : scene.warnings) show_note(progress, "warning: " + warning);
    const std::vector<const Receiver*> receivers = choose_receivers(scene, options);
    if (scene.lights == 0)
        show_note(progress, fmt::format("warning: {}: the scene has no light: the image is black",
                                        options.scene.string()));

    RenderSettings settings;
    std::vector<FilmView> views;
    std::vector<std::string> names;
    for (const Receiver* receiver : receivers) {
        const ImageSize size = image_size(*receiver, options);
        views.push_back({receiver->ref, size.width, size.height});
        names.push_back(receiver->name);
        settings.stokes |= receiver->wants_stokes;
        if (receiver->wants_stokes && !scene.features.polarization)
            show_note(progress,
                      fmt::format("warning: {} asks for Stokes vectors: without polarization there are none",
                                  receiver->name));
    }
    set_views(settings, views);
    const std::vector<std::filesystem::path> files = output_files(options.output, names);
    for (const auto& file : files)
        if (!file.empty()) check_writable(file);
    settings.algorithm = options.algorithm;
    settings.forward_paths = options.forward_paths.value_or(settings.forward_paths);
    settings.schedule = options.schedule;
    settings.vertex_bytes = options.vertex_bytes;
    settings.spectral_bins = options.spectral_bins;
    settings.layers = choose_layers(scene, options);
    settings.ledger = !options.stats.empty();
    settings.seed = uint32_t(options.seed ^ (options.seed >> 32));
    Checkpoints checkpoints(options, opened, receivers);
    settings.choice = checkpoints.choice();
    ChooseMeanwhile chooses(device, scene, options, settings, *receivers.front());
    std::unique_ptr<Renderer> renderer = chooses.make_renderer();
    renderer->begin_at(options.first_pass);
    if (const std::string note = checkpoints.restore(*renderer); !note.empty()) show_note(progress, note);
    if (const std::string& note = chooses.note(); !note.empty()) show_note(progress, note);
    if (const std::string missed = missed_light(scene, renderer->choice().algorithm); !missed.empty())
        show_note(progress, "warning: " + missed);
    const double setup_seconds = seconds_since(start);

    RenderStatus status;
    status.seconds_goal = options.seconds, status.error_goal = options.error;
    if (options.passes) status.passes_goal = renderer->passes() + passes_left(options, *renderer);
    status.passes_before = renderer->passes();
    uint64_t rays_before = all_rays(renderer->counters());
    auto render_start = Clock::now();
    double next_checkpoint = checkpoint_seconds;
    ErrorGoal error_goal{options.error.value_or(0)};
    const bool is_sobol = !scene.features.independent_samples;
    bool accurate = false;
    const auto has_all = [&] { return options.passes && passes_left(options, *renderer) == 0; };
    bool done = has_all();
    while ((!done || chooses.is_open()) && !interrupted()) {
        if (chooses.has_chosen()) {  // the two ways are not mixed: backward rays alone may have missed light
            if (chooses.take()) {
                renderer.reset();  // two may not fit
                renderer = chooses.make_renderer();
                renderer->begin_at(options.first_pass);
                checkpoints.drop_earlier();
                status.passes_before = rays_before = 0;
                status.passes_goal = options.passes;
                render_start = Clock::now();
                next_checkpoint = checkpoint_seconds;
                error_goal = ErrorGoal{options.error.value_or(0)};
                status.seconds = 0;
                status.error.reset(), status.even_passes.reset();
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
        if (options.seconds && !status.even_passes)
            batch = std::min(batch, *options.seconds - status.seconds);
        uint32_t count = renderer->passes_in(batch);
        if (status.even_passes)
            count = uint32_t(std::min<uint64_t>(count, *status.even_passes - renderer->passes()));
        else if (options.passes)
            count = uint32_t(std::min<uint64_t>(count, passes_left(options, *renderer)));
        renderer->render_passes(count);
        status.passes = renderer->passes();
        status.seconds = seconds_since(render_start);
        status.rays = double(all_rays(renderer->counters()) - rays_before);
        if (options.error && error_goal.is_due(renderer->passes())) {
            const RelativeError error = renderer->relative_error();
            status.error = error.value();
            accurate = error_goal.look(renderer->passes(), error);
        }
        if (status.even_passes) {
            done = renderer->passes() >= *status.even_passes;
        } else {
            done = has_all() || (options.seconds && status.seconds >= *options.seconds) || accurate;
            const uint64_t end = passes_to_end_at(renderer->passes(), status.passes_before);
            if (done && !options.passes && is_sobol && end > renderer->passes()) {
                status.even_passes = end;
                done = false;
            }
        }
        if (!chooses.is_open() && status.seconds >= next_checkpoint) {
            try {
                checkpoints.save(*renderer);
            } catch (const Error& error) {  // the next one may be written, and the image in any case
                if (error.code != ExitCode::bad_input) throw;
                show_note(progress, std::string("warning: ") + error.what());
            }
            next_checkpoint = seconds_since(render_start) + checkpoint_seconds;
        }
        show_progress(progress, status);
    }
    finish_progress(progress, status);

    Outputs outputs;
    std::vector<Image> images;
    for (size_t v = 0; v < receivers.size(); ++v) {
        Image& image = images.emplace_back(renderer->develop(options.aovs, v));
        const bool sees_things = receivers[v]->info->pixel_unit.empty();  // a camera does
        if (options.aovs && sees_things) renderer->add_aovs(image, aov_samples, v);
        image.attributes["pixelUnit"] = receiver_unit(*receivers[v]);
        if (options.aovs && has_stokes(image)) add_polarization(image);
        renderer->add_spectra(image, v);
        image.attributes.merge(std::map<std::string, Attribute>{
            {"scene", options.scene.string()},
            {"receiver", receivers[v]->name},
            {"command", options.command_line},
            {"seed", double(options.seed)},
            {"passes", double(renderer->passes())},
            {"rays", double(all_rays(renderer->counters()))},
            {"seconds", renderer->seconds()},
            {"algorithm", std::string(algorithm_name(renderer->choice().algorithm))},
            {"device", device.description.name},
            {"driver", device.description.driver},
            {"version", std::string(ETENDUE_VERSION)}});
        if (!options.output.empty()) outputs.write([&] { write_exr(files[v], image); });
    }
    if (!options.stats.empty())
        outputs.write([&] {
            write_stats(options.stats, options, device, scene, *renderer, renderer->relative_error(),
                        setup_seconds);
        });
    outputs.write([&] { checkpoints.save(*renderer, images); });
    if (renderer->counters().non_finite)
        show_note(progress, fmt::format("warning: {} samples were not finite and count as black",
                                        renderer->counters().non_finite));
    if (renderer->counters().depth_limit)
        show_note(progress, fmt::format("warning: {} paths were cut at the depth limit",
                                        renderer->counters().depth_limit));
    outputs.finish();
    return int(interrupted() && !done ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace etendue
