// The command line of `etendue view`.
#pragma once
#include <optional>
#include <string>

#include "host/commands.h"

namespace CLI {
class App;
}

namespace etendue {

// Arguments as text (host/cli_values.h).
struct ViewArguments {
    std::optional<std::string> passes, size, exposure, spectral_bins;
    std::string seed = "0", algorithm = "auto", color = "auto", schedule = "auto", sampler = "sobol",
                vertex_memory = "256", curve = "srgb";
};

CLI::App* add_view(CLI::App& app, ViewOptions& options, ViewArguments& arguments);
void finish_view(ViewOptions& options, const ViewArguments& arguments);

}  // namespace etendue
