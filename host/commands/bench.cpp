// etendue bench: the error of the algorithms against their time.
#include <algorithm>
#include <cmath>

#include "host/bench/measure.h"
#include "host/bench/report.h"
#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/outputs.h"
#include "host/image/png.h"
#include "host/interrupt.h"
#include "host/open_scene.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

constexpr double reference_times = 4;  // a self-made reference takes that many times an algorithm's time
constexpr double other_unit = 2;       // a mean that many times the reference's, or its inverse, is suspect

// The name of a scene in files and tables: its file's, or its folder's where the file is only called "scene".
std::string scene_name(const fs::path& file, const std::vector<BenchScene>& others) {
    std::string name = file.stem().string();
    if (name == "scene" && file.has_parent_path())
        name = fs::absolute(file).parent_path().filename().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    const auto taken = [&](const std::string& candidate) {
        return std::any_of(others.begin(), others.end(),
                           [&](auto& other) { return other.name == candidate; });
    };
    std::string unique = name;
    for (int i = 2; taken(unique); ++i) unique = fmt::format("{}-{}", name, i);
    return unique;
}

Reference read_reference(const BenchOptions& options) {
    Reference reference;
    reference.image = read_exr(options.reference);
    reference.origin = options.reference.string();
    const double error = estimated_relative_error(reference.image);
    if (options.reference_relmse)
        reference.relmse = *options.reference_relmse;
    else if (std::isfinite(error))
        reference.relmse = error * error;
    remove_channels(reference.image, "error.");
    reference.image.attributes.clear();
    return reference;
}

std::vector<Contestant> make_contestants(const BenchOptions& options, OpenedScene& opened,
                                         const RenderSettings& common, BenchScene& scene,
                                         Progress& progress) {
    std::vector<Contestant> contestants;
    for (const Algorithm algorithm : options.algorithms) {
        RenderSettings settings = common;
        settings.algorithm = algorithm;
        try {
            contestants.push_back(
                {algorithm, std::make_unique<Renderer>(*opened.device, opened.scene, settings)});
            contestants.back().renderer->render_passes(1);  // the driver finishes its compiling
            const AlgorithmChoice& choice = contestants.back().renderer->choice();
            if (algorithm != Algorithm::automatic) continue;
            scene.notes.push_back(fmt::format("auto: {}: {}; a pilot of {:.2g} s is not in its times",
                                              algorithm_name(choice.algorithm), choice.reason,
                                              choice.pilot_seconds));
            show_note(progress, scene.notes.back());
        } catch (const Error& error) {
            if (error.code != ExitCode::bad_input) throw;
            scene.notes.push_back(fmt::format("{}: left out: {}", algorithm_name(algorithm), error.what()));
            show_note(progress, scene.notes.back());
        }
    }
    if (contestants.empty())
        fail_input("{}: {}", options.scene.string(),
                   scene.notes.empty() ? "no algorithm" : scene.notes.front());
    return contestants;
}

// `options` with one scene. What is found goes into `results` as it is found.
void bench_scene(const BenchOptions& options, BenchResults& results, Progress& progress, Outputs& outputs) {
    const fs::path& folder = options.output;
    OpenedScene opened = open_scene(options);
    const Receiver& receiver = choose_receiver(opened.scene, options);
    std::optional<Reference> reference;
    if (!options.reference.empty()) reference = read_reference(options);
    ImageSize size = image_size(receiver, options);
    if (reference && !options.size) size = {reference->image.width, reference->image.height};
    if (reference && (reference->image.width != size.width || reference->image.height != size.height))
        fail_input("--reference {}: {} x {} pixels, and the images have {} x {}", options.reference.string(),
                   reference->image.width, reference->image.height, size.width, size.height);

    BenchScene scene;
    scene.name = scene_name(options.scene, results.scenes);
    scene.file = options.scene.string();
    scene.width = size.width, scene.height = size.height;
    scene.device = opened.device->description.name + ", " + opened.device->description.driver;
    show_note(progress, fmt::format("{}: {} x {} pixels", scene.name, size.width, size.height));
    for (const std::string& warning : opened.scene.warnings) show_note(progress, "warning: " + warning);

    RenderSettings settings;
    settings.width = size.width, settings.height = size.height;
    settings.receiver = receiver.ref;
    settings.vertex_bytes = options.vertex_bytes;
    auto contestants = make_contestants(options, opened, settings, scene, progress);
    if (!reference)
        reference = render_reference(contestants, reference_times * options.seconds, uint32_t(options.seed),
                                     progress);
    if (!reference) return;
    scene.reference = reference->origin, scene.reference_relmse = reference->relmse;
    results.scenes.push_back(scene);
    measure_contestants(contestants, *reference, options.seconds, uint32_t(options.seed), progress,
                        [&](BenchPoint point) {
                            point.scene = scene.name;
                            results.points.push_back(std::move(point));
                            outputs.write([&] { write_results(folder, results); });
                        });
    for (const BenchCurve& curve : curves(results, scene)) {
        const double factor = 1 + curve.bias.value;
        if (factor <= other_unit && factor >= 1 / other_unit) continue;
        results.scenes.back().notes.push_back(
            fmt::format("warning: {}: the mean is {:.3g} times the reference's: is that in another unit than "
                        "this renderer's, where white of 1 cd/m² is 1?",
                        curve.algorithm, factor));
        show_note(progress, results.scenes.back().notes.back());
        outputs.write([&] { write_results(folder, results); });
    }

    // All pictures of a scene are as bright as its reference: of a mean that shows.
    const auto values = plane(reference->image, size_t(picture_channels(reference->image)[1]));
    double mean = 0;
    for (float value : values) mean += std::isfinite(value) ? value / double(values.size()) : 0.0;
    const float exposure = mean > 0 ? float(std::log2(0.25 / mean)) : 0;
    outputs.write([&] { write_exr(folder / (scene.name + ".reference.exr"), reference->image); });
    outputs.write([&] { write_png(folder / (scene.name + ".reference.png"), reference->image, exposure); });
    for (const Contestant& c : contestants)
        if (c.longest > 0)
            outputs.write([&] {
                write_png(folder / fmt::format("{}.{}.png", scene.name, algorithm_name(c.algorithm)), c.image,
                          exposure);
            });
}

void report(const BenchOptions& options, const BenchResults& results, Progress& progress, Outputs& outputs) {
    outputs.write([&] {
        if (const std::string failure = draw_plots(options.output, results); !failure.empty())
            show_note(progress, failure);
    });
    outputs.write([&] { write_page(options.output, results); });
    for (const BenchScene& scene : results.scenes)
        fmt::print("{}\n{}\n", scene.name, as_text(summary_table(curves(results, scene))));
}

}  // namespace

int bench_command(const BenchOptions& options) {
    Progress progress;
    progress.style = progress_style(options.quiet);
    Outputs outputs;
    if (options.scenes.empty()) {
        report(options, read_results(options.output), progress, outputs);
        outputs.finish();
        return int(ExitCode::done);
    }
    for (const fs::path& scene : options.scenes)
        import_gltf(scene, import_options(options));  // what is wrong shows before the work
    prepare_output_folder(options.output, "bench.csv", "bench");
    catch_interrupts();
    BenchResults results;
    for (const fs::path& scene : options.scenes) {
        if (interrupted()) break;
        BenchOptions one = options;
        one.scene = scene;
        bench_scene(one, results, progress, outputs);
    }
    if (!results.points.empty()) report(options, results, progress, outputs);
    outputs.finish();
    return int(interrupted() ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace etendue
