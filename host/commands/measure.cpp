// etendue measure: what the meters of a scene read, until a number of passes, a time or an error is reached.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "host/commands.h"
#include "host/commands/film_checkpoint.h"
#include "host/commands/measure_checkpoint.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/interrupt.h"
#include "host/measure/report.h"
#include "host/progress.h"
#include "host/render/automatic.h"

namespace etendue {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double batch_seconds = 2;        // of work between two looks at clock and error
constexpr double checkpoint_seconds = 30;  // between two checkpoints

std::vector<const Receiver*> choose_meters(const Scene& scene, const MeasureOptions& options) {
    std::vector<const Receiver*> meters;
    std::string names;
    for (const Receiver& receiver : scene.receivers) {
        if (receiver.info->pixel_unit.empty()) continue;
        names += (names.empty() ? "" : ", ") + receiver.name;
        if (options.receivers.empty()) meters.push_back(&receiver);
    }
    if (names.empty())
        fail_input(
            "{}: has no receiver that measures (illuminance, intensity, luminance_meter, rays, surface): see "
            "etendue render",
            options.scene.string());
    for (const std::string& name : options.receivers) {
        const auto found =
            std::find_if(scene.receivers.begin(), scene.receivers.end(),
                         [&](const Receiver& r) { return r.name == name && !r.info->pixel_unit.empty(); });
        if (found == scene.receivers.end())
            fail_input("--receivers {}: there is no meter of that name; allowed: {}", name, names);
        meters.push_back(&*found);
    }
    return meters;
}

}  // namespace

int measure_command(const MeasureOptions& options) {
    if (!options.output.empty()) prepare_output_folder(options.output, "figures.csv", "measurement");
    if (!options.checkpoint.empty()) check_writable(options.checkpoint);
    catch_interrupts();
    Progress progress;
    progress.style = progress_style(options.quiet);
    OpenedScene opened = open_scene(options);
    Scene& scene = opened.scene;
    for (const std::string& warning : scene.warnings) show_note(progress, "warning: " + warning);
    if (scene.lights == 0)
        show_note(progress, fmt::format("warning: {}: the scene has no light", options.scene.string()));

    RenderSettings settings;
    settings.algorithm = options.algorithm;
    settings.forward_paths = options.forward_paths.value_or(settings.forward_paths);
    settings.vertex_bytes = options.vertex_bytes;
    settings.seed = uint32_t(options.seed);
    settings.spectral_bins = options.spectral_bins;
    settings.layers = choose_layers(scene, options);
    MeasurementRun run(*opened.device, scene, choose_meters(scene, options), settings);
    Measurement& measurement = run.measurement();
    if (const std::string missed = missed_light(scene, measurement.choice.algorithm); !missed.empty())
        show_note(progress, "warning: " + missed);
    const nlohmann::json identity = measurement_identity(source_hashes(opened, options), options, scene, run);
    std::vector<std::string> devices = {device_text(*opened.device)};
    if (!options.resume.empty()) {
        Checkpoint earlier = read_checkpoint(options.resume);
        require_identity(options.resume, earlier.identity, identity, "now");
        add(measurement, measurement_of(earlier, options.resume));
        for (const std::string device : earlier.about.at("devices"))
            if (device != devices[0]) devices.push_back(device);
    }
    const auto checkpoint = [&] { return to_checkpoint(identity, measurement, devices, options); };
    const auto save = [&] { write_checkpoint(options.checkpoint, checkpoint()); };

    RenderStatus status;
    status.seconds_goal = options.seconds, status.error_goal = options.error;
    const uint64_t end = options.passes ? options.first_pass + *options.passes : UINT64_MAX / 2;
    const auto left = [&] {
        uint64_t count = 0;
        if (options.passes)
            for (const PassRange& range : measurement.passes.missing(options.first_pass, end))
                count += range.count();
        return count;
    };
    status.passes_before = measurement.passes.count();
    if (options.passes) status.passes_goal = status.passes_before + left();
    const uint64_t rays_before = run.rays();
    const double seconds_before = measurement.seconds;
    const auto start = Clock::now();
    double next_checkpoint = checkpoint_seconds;
    uint64_t batch = replicates;
    bool done = options.passes && left() == 0;
    while (!done && !interrupted()) {
        uint64_t most = batch;
        if (options.passes) most = std::min(most, left());
        const PassRange range = measurement.passes.next_missing(options.first_pass, most);
        const double before = measurement.seconds;
        if (!run.add(range, interrupted)) break;
        const double took = measurement.seconds - before;
        status.passes = measurement.passes.count();
        status.seconds = seconds_since(start);
        status.rays = double(run.rays() - rays_before);
        status.error = relative_error(measurement, options.worst);
        if (2 * took < batch_seconds) batch *= 2;
        // An error of 0: no noise, or no light so far.
        const bool is_known = status.passes >= (*status.error > 0 ? 2 : 64) * replicates;
        done = (options.passes && left() == 0) || (options.seconds && status.seconds >= *options.seconds) ||
               (options.error && is_known && *status.error <= *options.error);
        if (!options.checkpoint.empty() && status.seconds >= next_checkpoint) {
            try {
                save();
            } catch (const Error& error) {  // the next one may be written, and the report in any case
                if (error.code != ExitCode::bad_input) throw;
                show_note(progress, std::string("warning: ") + error.what());
            }
            next_checkpoint = seconds_since(start) + checkpoint_seconds;
        }
        show_progress(progress, status);
    }
    finish_progress(progress, status);
    measurement.seconds = seconds_before + seconds_since(start);

    if (measurement.passes.count() > 0 && !interrupted())
        for (const std::string& name : run.probe_dark_meters())
            show_note(progress,
                      fmt::format("warning: {}: forward rays bring light that backward rays miss: use "
                                  "--algorithm bidirectional",
                                  name));
    for (const Readings& readings : measurement.meters)
        if (measurement.passes.count() > 0 && is_dark(readings))
            show_note(progress,
                      fmt::format("{}: {}", readings.meter.name, darkness_text(readings, measurement.power)));

    Outputs outputs;
    if (!options.output.empty() && measurement.passes.count() > 0) {
        const ReportOptions report = report_options(checkpoint(), options.output, options.command_line);
        const MeterFigures figures = all_figures(report, measurement);
        for (const std::string& note : write_report(report, measurement, figures, outputs))
            show_note(progress, note);
        for (size_t m = 0; m < figures.size() && !options.quiet; ++m)
            fmt::print("{}\n{}\n", measurement.meters[m].meter.name, as_text(figure_table(figures[m])));
    }
    if (!options.checkpoint.empty() && measurement.passes.count() > 0) outputs.write(save);
    outputs.finish();
    return int(interrupted() && !done ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace etendue
