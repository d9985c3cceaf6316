#include "host/cli/cli.h"

#include <CLI/CLI.hpp>

#include "host/cli/lens.h"
#include "host/cli/measure.h"
#include "host/cli/merge.h"
#include "host/cli/rays.h"
#include "host/cli/render.h"
#include "host/cli/shared.h"
#include "host/cli/values.h"
#include "host/cli/view.h"
#include "host/error.h"

#ifndef ETENDUE_VERSION
#define ETENDUE_VERSION "unknown"
#endif

namespace etendue {
namespace {

const char* overview =
    "Exit codes: 0 done, 1 a comparison failed, 2 bad usage or bad scene, 3 no usable device or the device "
    "failed,\n"
    "130 interrupted (the image so far is written).";

std::string quoted_command(int argc, const char* const* argv) {
    std::string line = "etendue";
    for (int i = 1; i < argc; ++i) {
        std::string word = argv[i];
        bool plain = !word.empty() && word.find_first_of(" \t\n\"'\\$&|;<>()*?[]#~`!{}") == std::string::npos;
        line += plain ? " " + word : " '" + word + "'";
    }
    return line;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& options, std::optional<std::string>& max_relmse) {
    CLI::App* compare =
        app.add_subcommand("compare", "Compare an image with a reference: relMSE, RMSE, bias, worst pixels");
    compare->add_option("A.exr", options.image, "Image")->required()->option_text(" ");
    compare->add_option("B.exr", options.reference, "Reference of the same size")
        ->required()
        ->option_text(" ");
    compare->add_option("--max-relmse", max_relmse, "Exit with 1 where relMSE is above X or not finite")
        ->option_text("X");
    compare->footer(
        "relMSE = mean((A-B)² / (B² + 0.01 mean(B)²)) over pixels and channels. Where both images have an "
        "error\n"
        "layer (render --aovs), a z-test tells whether they differ by more than their noise.");
    return compare;
}

struct BenchArguments {
    std::optional<std::string> seconds, reference_relmse;
    std::string algorithms = "backward,forward,bidirectional,auto";
    SharedArguments shared;
};

CLI::App* add_bench(CLI::App& app, BenchOptions& options, BenchArguments& arguments) {
    CLI::App* bench = app.add_subcommand("bench", "Error against time of the algorithms: table and plots");
    bench->add_option("SCENE", options.scenes, "Scenes; none draws the page in DIR again")->option_text("…");
    bench->add_option("-o,--output", options.output, "Folder for bench.csv, index.html and images")
        ->required()
        ->option_text("DIR");
    bench
        ->add_option("--reference", options.reference,
                     "Image to measure against (default: one is rendered, in four times SEC)")
        ->option_text("REF.exr");
    bench
        ->add_option("--reference-relmse", arguments.reference_relmse,
                     "relMSE that the reference itself has (default: by its error layer, else 0)")
        ->option_text("X");
    bench->add_option("--algorithms", arguments.algorithms, "Of auto, backward, forward, bidirectional; all")
        ->option_text("A,B,…");
    bench->add_option("--time", arguments.seconds, "Seconds of rendering for each algorithm (default: 30)")
        ->option_text("SEC");
    add_shared(*bench, options, arguments.shared,
               {{"size", "As for render (default: the reference's)"},
                {"receiver"},
                {"variant"},
                {"at"},
                {"environment"},
                {"vertex-memory"},
                {"color"},
                {"polarization"},
                {"sampler"},
                {"seed", "First seed (default: 0)"},
                {"device"},
                {"shaders"},
                {"allow-class-files"}});
    bench->add_flag("-q,--quiet", options.quiet, "No progress and no warnings");
    bench->get_option("SCENE")->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return bench;
}

void finish_bench(BenchOptions& options, const BenchArguments& arguments) {
    if (arguments.seconds) options.seconds = parse_positive(*arguments.seconds, "--time", ", in seconds");
    finish_shared(options, arguments.shared);
    if (arguments.reference_relmse)
        options.reference_relmse = parse_positive(*arguments.reference_relmse, "--reference-relmse", "");
    if (options.reference_relmse && options.reference.empty())
        fail_input("--reference-relmse: goes with --reference");
    if (!options.reference.empty() && options.scenes.size() > 1)
        fail_input("--reference: goes with one scene, not with {}", options.scenes.size());
    options.seed = parse_count(arguments.shared.seed, "--seed", 0, INT32_MAX);
    options.vertex_bytes = parse_mebibytes(arguments.shared.vertex_memory, "--vertex-memory");
    options.algorithms = parse_algorithms(arguments.algorithms, "--algorithms");
}

CLI::App* add_inspect(CLI::App& app, InspectOptions& options, SharedArguments& arguments) {
    CLI::App* inspect =
        app.add_subcommand("inspect", "Objects, classes, features, kernels and memory of a scene");
    inspect->add_option("SCENE", options.scene, "Scene, .gltf or .glb")->required()->option_text(" ");
    add_shared(*inspect, options, arguments,
               {{"size"},
                {"receiver", "Camera (default: the scene's first)"},
                {"variant"},
                {"at"},
                {"environment"},
                {"algorithm", "Whose kernels are compiled (default: auto, which may run a pilot)"},
                {"color"},
                {"polarization"},
                {"spectral-bins"},
                {"device"},
                {"shaders"},
                {"allow-class-files"}});
    inspect->add_flag("--json", options.json,
                      "Only what --algorithm auto chooses, with the words that make render do the same");
    return inspect;
}

CLI::App* add_classes(CLI::App& app, ClassesOptions& options, std::optional<std::string>& passes) {
    CLI::App* classes =
        app.add_subcommand("classes", "Registered classes, their parameters, units, defaults and ranges");
    classes->add_option("NAME", options.name, "Only this class")->option_text(" ");
    auto* html = classes->add_option("--html", options.html,
                                     "Write a page instead, with examples and pictures of them");
    html->option_text("FILE.html");
    classes->add_option("--passes", passes, "Of each picture (default: 128)")->option_text("N")->needs(html);
    classes->add_option("--device", options.device, "As for render, for the pictures")
        ->option_text("NAME|INDEX")
        ->needs(html);
    classes->add_option("--shaders", options.shaders, "As for render")->option_text("DIR");
    classes->add_flag("-q,--quiet", options.quiet, "No progress and no warnings")->needs(html);
    return classes;
}

void finish_classes(ClassesOptions& options, const std::optional<std::string>& passes) {
    if (passes) options.passes = uint32_t(parse_count(*passes, "--passes", 1, 1 << 20));
    if (!options.html.empty() && options.html.extension() != ".html")
        fail_input("--html {}: a page; its name must end in .html", options.html.string());
}

// CLI11 calls a missing value by its type's name.
std::string readable(std::string message) {
    if (size_t at = message.find("1 required TEXT missing"); at != std::string::npos)
        message.replace(at, std::string::npos, "value is missing");
    return message;
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
    CLI::App app("étendue: a physically accurate renderer and lighting simulator", "etendue");
    app.set_version_flag("-v,--version", "etendue " ETENDUE_VERSION);
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.footer(overview);
    app.require_subcommand(0, 1);
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);

    RenderOptions render_options;
    RenderArguments render_arguments;
    MeasureOptions measure_options;
    MeasureArguments measure_arguments;
    CompareOptions compare_options;
    std::optional<std::string> max_relmse;
    BenchOptions bench_options;
    BenchArguments bench_arguments;
    ViewOptions view_options;
    ViewArguments view_arguments;
    RaysOptions rays_options;
    RaysArguments rays_arguments;
    InspectOptions inspect_options;
    SharedArguments inspect_arguments;
    LensOptions lens_options;
    LensTexts lens_texts;
    MergeOptions merge_options;
    std::optional<std::string> merge_passes;
    ClassesOptions classes_options;
    std::optional<std::string> classes_passes;
    CLI::App* render = add_render(app, render_options, render_arguments);
    CLI::App* measure = add_measure(app, measure_options, measure_arguments);
    CLI::App* compare = add_compare(app, compare_options, max_relmse);
    CLI::App* bench = add_bench(app, bench_options, bench_arguments);
    CLI::App* view = add_view(app, view_options, view_arguments);
    CLI::App* rays = add_rays(app, rays_options, rays_arguments);
    CLI::App* inspect = add_inspect(app, inspect_options, inspect_arguments);
    CLI::App* merge = add_merge(app, merge_options, merge_passes);
    CLI::App* lens = add_lens(app, lens_options, lens_texts);
    CLI::App* classes = add_classes(app, classes_options, classes_passes);
    CLI::App* devices =
        app.add_subcommand("devices", "Vulkan devices, drivers, limits, and which is the default");

    const auto commands = {render, measure, merge, view,    rays,   compare,
                           bench,  inspect, lens,  classes, devices};
    std::string first = argc < 2 ? "" : argv[1];
    bool known = first.starts_with("-");
    for (CLI::App* command : commands) known = known || first == command->get_name();
    if (!known)
        fail_input(
            "{}; one of: render, measure, merge, view, rays, compare, bench, inspect, lens, classes, devices "
            "(see etendue --help)",
            argc < 2 ? "no command given" : fmt::format("no command '{}'", first));

    CLI::App* chosen = &app;
    auto command_name = [&] {
        for (CLI::App* command : commands)
            if (command->parsed()) chosen = command;
        return chosen == &app ? std::string("etendue") : "etendue " + chosen->get_name();
    };
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        command_name();
        return TextAnswer{chosen->help(chosen == &app ? "" : "etendue", CLI::AppFormatMode::Normal)};
    } catch (const CLI::CallForVersion& version) {
        return TextAnswer{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& e) {
        std::string name = command_name();
        fail_input("{} (see {} --help)", readable(e.what()), name);
    }
    if (render->parsed()) {
        finish_render(render_options, render_arguments, quoted_command(argc, argv));
        return render_options;
    }
    if (measure->parsed()) {
        finish_measure(measure_options, measure_arguments, quoted_command(argc, argv));
        return measure_options;
    }
    if (merge->parsed()) {
        finish_merge(merge_options, merge_passes, quoted_command(argc, argv));
        return merge_options;
    }
    if (compare->parsed()) {
        if (max_relmse) compare_options.max_relmse = parse_positive(*max_relmse, "--max-relmse", "");
        return compare_options;
    }
    if (bench->parsed()) {
        finish_bench(bench_options, bench_arguments);
        return bench_options;
    }
    if (rays->parsed()) {
        finish_rays(rays_options, rays_arguments);
        return rays_options;
    }
    if (view->parsed()) {
        finish_view(view_options, view_arguments);
        return view_options;
    }
    if (inspect->parsed()) {
        finish_shared(inspect_options, inspect_arguments);
        inspect_options.algorithm = parse_algorithm(inspect_arguments.algorithm, "--algorithm");
        if (inspect_options.json && inspect_options.algorithm != Algorithm::automatic)
            fail_input("--json: tells what auto chooses, and goes without --algorithm");
        return inspect_options;
    }
    if (lens->parsed()) {
        finish_lens(lens_options, lens_texts);
        return lens_options;
    }
    if (classes->parsed()) {
        finish_classes(classes_options, classes_passes);
        return classes_options;
    }
    if (devices->parsed()) return DevicesOptions{};
    fail_input("no command given (see etendue --help)");
}

}  // namespace etendue
