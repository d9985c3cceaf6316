#include "host/cli/shared.h"

#include <CLI/CLI.hpp>

#include "host/cli/values.h"

namespace etendue {

void add_shared(CLI::App& command, SceneChoice& options, SharedArguments& arguments,
                std::initializer_list<SharedOption> wanted) {
    for (const SharedOption& option : wanted) {
        const std::string name = std::string("--") + option.name;
        const auto add = [&](const char* known, auto& target, const char* value) {
            if (name == known) command.add_option(name, target, option.text)->option_text(value);
        };
        add("--size", arguments.size, "WxH");
        add("--layers", options.layers, "lamps|none|FILE.json|[…]");
        add("--receiver", options.receiver, "NAME");
        add("--variant", options.variant, "NAME");
        add("--at", arguments.at, "SECONDS");
        add("--environment", options.environment, "FILE.hdr|exr");
        add("--algorithm", arguments.algorithm, "auto|backward|forward|bidirectional");
        add("--vertex-memory", arguments.vertex_memory, "MIB");
        add("--color", arguments.color, "auto|rgb|spectral");
        add("--polarization", arguments.polarization, "auto|on|off");
        add("--spectral-bins", arguments.spectral_bins, "N");
        add("--schedule", arguments.schedule, "auto|fused|wavefront|by-class");
        add("--sampler", arguments.sampler, "sobol|independent");
        add("--seed", arguments.seed, "N");
        add("--device", options.device, "NAME|INDEX");
        add("--shaders", options.shaders, "DIR");
        if (name == "--allow-class-files") command.add_flag(name, options.allow_class_files, option.text);
    }
}

void finish_shared(SceneChoice& options, const SharedArguments& arguments) {
    if (arguments.size) options.size = parse_size(*arguments.size);
    if (arguments.at) options.at = parse_moment(*arguments.at);
    if (arguments.spectral_bins)
        options.spectral_bins = uint32_t(parse_count(*arguments.spectral_bins, "--spectral-bins", 1, 470));
    options.color = parse_color(arguments.color);
    options.polarization = parse_polarization(arguments.polarization);
    options.samples = parse_sampler(arguments.sampler);
}

}  // namespace etendue
