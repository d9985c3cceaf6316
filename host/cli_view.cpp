#include "host/cli_view.h"

#include <CLI/CLI.hpp>

#include "host/cli_values.h"

namespace etendue {

CLI::App* add_view(CLI::App& app, ViewOptions& options, ViewArguments& arguments) {
    CLI::App* view = app.add_subcommand("view", "A window on a scene, which refines while one looks");
    view->add_option("SCENE", options.scene, "Scene, .gltf or .glb")->required()->option_text(" ");
    view->add_option("--size", arguments.size, "Size of the window in pixels (default: 1280x720)")
        ->option_text("WxH");
    view->add_option("--receiver", options.receiver, "Camera to begin with (default: the scene's first)")
        ->option_text("NAME");
    view->add_option("--passes", arguments.passes, "Rest after N passes (default: never)")->option_text("N");
    view->add_option("--exposure", arguments.exposure,
                     "Powers of two that the picture is brighter (default: metered)")
        ->option_text("EV");
    view->add_option("--tone-curve", arguments.curve, "To begin with (default: srgb)")
        ->option_text("none|srgb|aces|agx|false");
    view->add_option("--environment", options.environment, "As for render")->option_text("FILE.hdr|exr");
    view->add_option("--algorithm", arguments.algorithm, "As for render")
        ->option_text("auto|backward|forward|bidirectional");
    view->add_option("--vertex-memory", arguments.vertex_memory, "As for render")->option_text("MIB");
    view->add_option("--color", arguments.color, "As for render")->option_text("auto|rgb|spectral");
    view->add_option("--spectral-bins", arguments.spectral_bins, "As for render")->option_text("N");
    view->add_option("--schedule", arguments.schedule, "As for render")
        ->option_text("auto|fused|wavefront|by-class");
    view->add_option("--sampler", arguments.sampler, "As for render")->option_text("sobol|independent");
    view->add_option("--seed", arguments.seed, "As for render")->option_text("N");
    view->add_option("--device", options.device, "As for render")->option_text("NAME|INDEX");
    view->add_option("--shaders", options.shaders,
                     "Read the shaders from a folder, again whenever they change")
        ->option_text("DIR");
    view->add_option("--stats", options.stats, "Write times and memory there when the window is closed")
        ->option_text("FILE.json");
    return view;
}

void finish_view(ViewOptions& options, const ViewArguments& arguments) {
    if (arguments.size) options.size = parse_size(*arguments.size);
    if (arguments.passes) options.passes = parse_count(*arguments.passes, "--passes", 1, INT32_MAX);
    if (arguments.exposure) options.exposure = parse_exposure(*arguments.exposure);
    if (arguments.spectral_bins)
        options.spectral_bins = uint32_t(parse_count(*arguments.spectral_bins, "--spectral-bins", 1, 470));
    options.seed = parse_count(arguments.seed, "--seed", 0, UINT32_MAX);
    options.vertex_bytes = parse_mebibytes(arguments.vertex_memory, "--vertex-memory");
    options.color = parse_color(arguments.color);
    options.samples = parse_sampler(arguments.sampler);
    options.algorithm = parse_algorithm(arguments.algorithm, "--algorithm");
    options.schedule = parse_schedule(arguments.schedule);
    options.curve = parse_choice<ToneCurve>(arguments.curve, "--tone-curve",
                                            {{"none", ToneCurve::linear},
                                             {"srgb", ToneCurve::srgb},
                                             {"aces", ToneCurve::aces},
                                             {"agx", ToneCurve::agx},
                                             {"false", ToneCurve::false_colors}});
}

}  // namespace etendue
