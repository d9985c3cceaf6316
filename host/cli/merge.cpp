#include "host/cli/merge.h"

#include <CLI/CLI.hpp>

#include "host/cli/values.h"
#include "host/error.h"

namespace etendue {

CLI::App* add_merge(CLI::App& app, MergeOptions& options, std::optional<std::string>& passes) {
    CLI::App* merge = app.add_subcommand(
        "merge", "Merge parts of one render or measurement, which --passes A:B --checkpoint makes");
    merge->add_option("PART", options.parts, "Checkpoints of different passes, in any order")
        ->required()
        ->option_text("…");
    merge->add_option("-o,--output", options.output, "Image to write; of a measurement, the folder")
        ->option_text("OUT.exr|DIR");
    merge
        ->add_option("--checkpoint", options.checkpoint,
                     "Write all passes there: a part to merge with others, or to render --resume from")
        ->option_text("FILE");
    merge
        ->add_option("--passes", passes,
                     "Passes that the parts must make up: the first N, or A to B - 1 (default: all up to "
                     "their last)")
        ->option_text("N|A:B");
    merge->add_flag("--partial", options.partial,
                    "Merge what there is where passes are missing or parts damaged, and say which");
    merge->add_flag("--aovs", options.aovs,
                    "Also write the layer error, and albedo, normal and depth of parts rendered with --aovs");
    merge->add_option("--stats", options.stats, "Write passes, counts, devices and the estimated error there")
        ->option_text("FILE.json");
    merge->add_flag("-q,--quiet", options.quiet, "Say nothing");
    merge->get_option("PART")->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return merge;
}

void finish_merge(MergeOptions& options, const std::optional<std::string>& passes, std::string command_line) {
    if (passes) {
        const PassCount wanted = parse_passes(*passes);
        options.first_pass = wanted.first, options.passes = wanted.count;
    }
    if (options.output.empty() && options.checkpoint.empty())
        fail_input("merge: --output or --checkpoint says where to (see etendue merge --help)");
    options.command_line = std::move(command_line);
}

}  // namespace etendue
