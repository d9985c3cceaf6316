#include "host/cli/render.h"

#include <CLI/CLI.hpp>

#include "host/cli/cli.h"
#include "host/cli/values.h"
#include "host/error.h"

namespace etendue {

CLI::App* add_render(CLI::App& app, RenderOptions& options, RenderArguments& arguments) {
    CLI::App* render = app.add_subcommand("render", "Render a glTF scene to an OpenEXR image");
    render->add_option("SCENE", options.scene, "Scene, .gltf or .glb")->required()->option_text(" ");
    render
        ->add_option(
            "-o,--output", options.output,
            "Image to write (default: the scene's name with .exr, here; none of a range with --checkpoint)")
        ->option_text("OUT.exr");
    auto* passes = render->add_option(
        "--passes", arguments.passes,
        "Stop after N passes: paths a pixel (default: 64); A:B makes passes A to B - 1 of a "
        "run, for merge");
    auto* seconds =
        render->add_option("--time", arguments.seconds,
                           "Stop after that many seconds of rendering, or up to a tenth later at a power of "
                           "two passes, where samples are most even");
    auto* error = render->add_option(
        "--error", arguments.error,
        "Stop when the relative error (root of the relMSE) is below E, with 95 % confidence, or up to a "
        "tenth later as for --time");
    passes->option_text("N|A:B")->excludes(seconds)->excludes(error);
    seconds->option_text("SEC")->excludes(error);
    error->option_text("E");
    add_shared(
        *render, options, arguments.shared,
        {{"size", "Size in pixels (default: 512 rows, columns by the camera's aspect)"},
         {"receiver",
          "Cameras and meters to render in one run, by name, or all (default: the scene's first)"},
         {"variant", "Of the scene's materials, as inspect lists them (default: none)"},
         {"at", "Moment of the scene's animations (default: as its nodes stand)"},
         {"environment", "Latitude-longitude image for the scene's surroundings"},
         {"layers",
          "Further layers, of parts of the light: one for each lamp, or as described (default: the scene's)"},
         {"algorithm", "How light is traced (default: auto)"}});
    render
        ->add_option("--forward-paths", arguments.forward_paths,
                     "Forward paths a pixel and pass, with a named algorithm that has them (default: 1)")
        ->option_text("X");
    add_shared(
        *render, options, arguments.shared,
        {{"vertex-memory",
          "Memory for vertices of forward paths; a pass that needs more is split (default: 256)"},
         {"color", "What a ray carries (default: auto)"},
         {"polarization", "Whether rays carry polarization (default: auto, where something polarizes)"},
         {"spectral-bins", "Also write the spectrum, in N equal bins from 360 to 830 nm"}});
    add_shared(*render, options, arguments.shared,
               {{"schedule", "Whole paths in one kernel, or a kernel a stage (default: auto)"},
                {"sampler", "Where random numbers come from (default: sobol)"},
                {"seed", "Seed of the random numbers (default: 0)"},
                {"device", "Vulkan device (default: the best; see: etendue devices)"}});
    render
        ->add_option("--checkpoint", options.checkpoint, "Keep the state there, to go on from with --resume")
        ->option_text("FILE");
    render->add_option("--resume", options.resume, "Go on from a checkpoint of the same scene and settings")
        ->option_text("FILE");
    render->add_option("--stats", options.stats, "Write counts, timings and the power balance there")
        ->option_text("FILE.json");
    add_shared(*render, options, arguments.shared,
               {{"shaders", "Read the shaders from a folder (default: those built in)"},
                {"allow-class-files", "Run code that the scene brings along: only where you trust it"}});
    render->add_flag("--aovs", options.aovs, "Also write the layers albedo, normal, depth and error");
    render->add_flag("-q,--quiet", options.quiet, "No progress and no warnings");
    return render;
}

void finish_render(RenderOptions& options, const RenderArguments& arguments, std::string command_line) {
    if (options.scene.empty()) fail_input("SCENE is empty (see etendue render --help)");
    PassCount passes{0, 64, false};
    if (arguments.passes || !(arguments.seconds || arguments.error)) {
        if (arguments.passes) passes = parse_passes(*arguments.passes);
        options.first_pass = passes.first, options.passes = passes.count;
    } else if (arguments.seconds)
        options.seconds = parse_positive(*arguments.seconds, "--time", ", in seconds");
    else if (arguments.error)
        options.error = parse_positive(*arguments.error, "--error", "");
    finish_shared(options, arguments.shared);
    options.seed = parse_count(arguments.shared.seed, "--seed", 0, UINT32_MAX);
    options.algorithm = parse_algorithm(arguments.shared.algorithm, "--algorithm");
    if (passes.is_range && options.algorithm == Algorithm::automatic && options.resume.empty())
        fail_input(
            "--passes {}: goes with a named --algorithm, since auto may choose another one elsewhere "
            "(etendue "
            "inspect --json says what it chooses)",
            *arguments.passes);
    if (arguments.forward_paths)
        options.forward_paths = parse_forward_paths(*arguments.forward_paths, options.algorithm);
    options.vertex_bytes = parse_mebibytes(arguments.shared.vertex_memory, "--vertex-memory");
    options.schedule = parse_schedule(arguments.shared.schedule);
    if (options.spectral_bins > 0 && options.color == ColorMode::rgb)
        fail_input("--spectral-bins: goes with --color spectral or auto, not with rgb");
    const bool is_part = passes.is_range && !options.checkpoint.empty();
    if (options.output.empty() && !is_part) options.output = default_output(options.scene);
    if (!options.output.empty() && options.output.extension() != ".exr")
        fail_input("--output {}: images are written as OpenEXR; the name must end in .exr",
                   options.output.string());
    options.command_line = std::move(command_line);
}

std::filesystem::path default_output(const std::filesystem::path& scene) {
    return scene.filename().replace_extension(".exr");
}

}  // namespace etendue
