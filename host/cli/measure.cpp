#include "host/cli/measure.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "host/cli/cli.h"
#include "host/cli/values.h"
#include "host/error.h"
#include "host/measure/figures.h"

namespace etendue {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, separator);) words.push_back(word);
    return words;
}

// "9", or "0.1,0.5;0.9,0.5".
std::vector<MeterPoint> parse_points(const std::string& text) {
    if (text == "5" || text == "9" || text == "13") return standard_points(uint32_t(std::stoul(text)));
    std::vector<MeterPoint> points;
    for (const std::string& pair : split(text, ';')) {
        std::istringstream stream(pair);
        MeterPoint point;
        char comma = 0;
        const bool is_pair = bool(stream >> point.x >> comma >> point.y) && comma == ',' &&
                             (stream >> std::ws).eof() && point.x >= 0 && point.x <= 1 && point.y >= 0 &&
                             point.y <= 1;
        if (!is_pair)
            fail_input(
                "--points {}: 5, 9, 13, or X,Y;X,Y… in parts of width and height from the upper left, 0 to 1",
                text);
        points.push_back(point);
    }
    if (points.size() < 2) fail_input("--points {}: at least two", text);
    return points;
}

}  // namespace

CLI::App* add_measure(CLI::App& app, MeasureOptions& options, MeasureArguments& arguments) {
    CLI::App* measure = app.add_subcommand(
        "measure", "What the meters of a scene read: a report with figures and their errors");
    measure->add_option("SCENE", options.scene, "Scene, .gltf or .glb")->required()->option_text(" ");
    measure
        ->add_option("-o,--output", options.output,
                     "Folder for index.html, figures.csv, and images and tables of each meter")
        ->option_text("DIR");
    auto* passes = measure->add_option("--passes", arguments.passes,
                                       "Stop after N passes: paths a pixel, in whole sixteens (default: "
                                       "256); A:B makes passes A to B - 1 of a "
                                       "run, for merge");
    auto* seconds = measure->add_option("--time", arguments.seconds, "Stop after that many seconds");
    auto* error = measure->add_option(
        "--error", arguments.error,
        "Stop when half the 95 % interval is below E times the value, of each meter's mean or worst pixel");
    passes->option_text("N|A:B")->excludes(seconds)->excludes(error);
    seconds->option_text("SEC")->excludes(error);
    error->option_text("E");
    measure->add_option("--error-of", arguments.error_of, "What --error judges (default: mean)")
        ->option_text("mean|worst")
        ->needs(error);
    measure->add_option("--receivers", arguments.receivers, "Meters to read (default: all)")
        ->option_text("NAME,NAME…|all");
    measure
        ->add_option("--points", arguments.points,
                     "Uniformity over 5, 9 or 13 points, or over those given in parts of width and height")
        ->option_text("5|9|13|X,Y;…");
    measure
        ->add_option("--glare-from", arguments.glare_from,
                     "Luminance, cd/m², above which something glares: for UGR (default: 500)")
        ->option_text("L");
    add_shared(*measure, options, arguments.shared,
               {{"variant"},
                {"at"},
                {"environment"},
                {"layers", "Also the readings of parts of the light, as for render (default: the scene's)"},
                {"algorithm", "How light is traced (default: auto)"}});
    measure
        ->add_option("--forward-paths", arguments.forward_paths,
                     "Forward paths a pixel and pass, with a named algorithm that has them (default: 1)")
        ->option_text("X");
    add_shared(*measure, options, arguments.shared,
               {{"vertex-memory"},
                {"color"},
                {"polarization"},
                {"spectral-bins",
                 "Also spectra, in N equal bins from 360 to 830 nm; of 47 or more colour rendering is told"},
                {"sampler"},
                {"seed"},
                {"device"}});
    measure
        ->add_option("--checkpoint", options.checkpoint, "Keep the readings there, to go on from or to merge")
        ->option_text("FILE");
    measure->add_option("--resume", options.resume, "Go on from a checkpoint of the same scene and settings")
        ->option_text("FILE");
    add_shared(*measure, options, arguments.shared, {{"shaders"}, {"allow-class-files"}});
    measure->add_flag("-q,--quiet", options.quiet, "No progress and no warnings");
    return measure;
}

void finish_measure(MeasureOptions& options, const MeasureArguments& arguments, std::string command_line) {
    if (options.scene.empty()) fail_input("SCENE is empty (see etendue measure --help)");
    PassCount passes{0, 256, false};
    if (arguments.passes || !(arguments.seconds || arguments.error)) {
        if (arguments.passes) passes = parse_passes(*arguments.passes);
        if (passes.first % replicates || passes.count % replicates)
            fail_input("--passes {}: measure makes passes by {}; name multiples of it", *arguments.passes,
                       replicates);
        options.first_pass = passes.first, options.passes = passes.count;
    } else if (arguments.seconds)
        options.seconds = parse_positive(*arguments.seconds, "--time", ", in seconds");
    else
        options.error = parse_positive(*arguments.error, "--error", "");
    if (arguments.error_of != "mean" && arguments.error_of != "worst")
        fail_input("--error-of {}: mean or worst", arguments.error_of);
    options.worst = arguments.error_of == "worst";
    if (arguments.receivers != "all") options.receivers = split(arguments.receivers, ',');
    if (arguments.points) options.points = parse_points(*arguments.points);
    if (arguments.glare_from)
        options.glare_from = parse_positive(*arguments.glare_from, "--glare-from", ", in cd/m²");
    finish_shared(options, arguments.shared);
    options.seed = parse_count(arguments.shared.seed, "--seed", 0, UINT32_MAX);
    options.algorithm = parse_algorithm(arguments.shared.algorithm, "--algorithm");
    if (arguments.forward_paths)
        options.forward_paths = parse_forward_paths(*arguments.forward_paths, options.algorithm);
    options.vertex_bytes = parse_mebibytes(arguments.shared.vertex_memory, "--vertex-memory");
    if (options.spectral_bins > 0 && options.color == ColorMode::rgb)
        fail_input("--spectral-bins: goes with --color spectral or auto, not with rgb");
    if (options.output.empty() && options.checkpoint.empty())
        fail_input("measure: --output or --checkpoint says where to (see etendue measure --help)");
    options.command_line = std::move(command_line);
}

}  // namespace etendue
