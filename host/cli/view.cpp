#include "host/cli/view.h"

#include <CLI/CLI.hpp>

#include "host/cli/values.h"

namespace etendue {

CLI::App* add_view(CLI::App& app, ViewOptions& options, ViewArguments& arguments) {
    CLI::App* view = app.add_subcommand("view", "A window on a scene, which refines while one looks");
    view->add_option("SCENE", options.scene, "Scene, .gltf or .glb")->required()->option_text(" ");
    add_shared(*view, options, arguments.shared,
               {{"size", "Size of the window in pixels (default: 1280x720)"},
                {"receiver", "Camera to begin with (default: the scene's first)"},
                {"variant", "Of the scene's materials, to begin with (default: none)"},
                {"at", "Moment of the scene's animations, to begin with (default: as its nodes stand)"}});
    view->add_option("--passes", arguments.passes, "Rest after N passes (default: never)")->option_text("N");
    view->add_option("--exposure", arguments.exposure,
                     "Powers of two that the picture is brighter (default: metered)")
        ->option_text("EV");
    view->add_option("--tone-curve", arguments.curve, "To begin with (default: srgb)")
        ->option_text("none|srgb|aces|agx|false");
    add_shared(*view, options, arguments.shared,
               {{"environment"},
                {"algorithm"},
                {"vertex-memory"},
                {"color"},
                {"polarization"},
                {"spectral-bins"},
                {"schedule"},
                {"sampler"},
                {"seed"},
                {"device"},
                {"shaders", "Read the shaders from a folder, again whenever they change"},
                {"allow-class-files", "Run code that the scene brings along, without asking"}});
    view->add_option("--stats", options.stats, "Write times and memory there when the window is closed")
        ->option_text("FILE.json");
    return view;
}

void finish_view(ViewOptions& options, const ViewArguments& arguments) {
    finish_shared(options, arguments.shared);
    if (arguments.passes) options.passes = parse_count(*arguments.passes, "--passes", 1, INT32_MAX);
    if (arguments.exposure) options.exposure = parse_exposure(*arguments.exposure);
    options.seed = parse_count(arguments.shared.seed, "--seed", 0, UINT32_MAX);
    options.vertex_bytes = parse_mebibytes(arguments.shared.vertex_memory, "--vertex-memory");
    options.algorithm = parse_algorithm(arguments.shared.algorithm, "--algorithm");
    options.schedule = parse_schedule(arguments.shared.schedule);
    options.curve = parse_choice<ToneCurve>(arguments.curve, "--tone-curve",
                                            {{"none", ToneCurve::linear},
                                             {"srgb", ToneCurve::srgb},
                                             {"aces", ToneCurve::aces},
                                             {"agx", ToneCurve::agx},
                                             {"false", ToneCurve::false_colors}});
}

}  // namespace etendue
