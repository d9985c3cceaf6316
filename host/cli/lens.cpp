#include "host/cli/lens.h"

#include <CLI/CLI.hpp>

#include "host/cli/values.h"
#include "host/error.h"

namespace etendue {

CLI::App* add_lens(CLI::App& app, LensOptions& options, LensTexts& texts) {
    CLI::App* lens = app.add_subcommand(
        "lens", "A lens file: prescription, focal lengths, pupils, spots, section with rays");
    lens->add_option("FILE", options.lens, "Zemax (.zmx), CODE V (.seq), or a table (scenes/FORMAT.md)")
        ->required()
        ->option_text(" ");
    lens->add_option("-o,--output", options.output,
                     "The section with rays (.svg), or rays from surface to surface (.csv)")
        ->option_text("FILE.svg|csv");
    lens->add_option("--object", texts.object,
                     "Focuses on an object in this distance from the first surface: the image moves")
        ->option_text("MM");
    lens->add_option("--rays", texts.rays,
                     "Rays of each field across the pupil: in a line (.svg), on a grid (.csv) (default: 7)")
        ->option_text("N");
    return lens;
}

void finish_lens(LensOptions& options, const LensTexts& texts) {
    const auto& rays = texts.rays;
    if (texts.object) options.object = parse_positive(*texts.object, "--object", ", in mm");
    if (rays) options.rays = uint32_t(parse_count(*rays, "--rays", 1, 1000));
    const std::string ending = options.output.extension().string();
    if (!options.output.empty() && ending != ".svg" && ending != ".csv")
        fail_input("--output {}: a drawing or a table of rays; the name must end in .svg or .csv",
                   options.output.string());
    if (rays && options.output.empty()) fail_input("--rays: goes with --output");
}

}  // namespace etendue
