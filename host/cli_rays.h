// The command line of `etendue rays`.
#pragma once
#include <optional>
#include <string>

#include "host/commands.h"

namespace CLI {
class App;
}

namespace etendue {

// Arguments as text (host/cli_values.h).
struct RaysArguments {
    std::optional<std::string> size, events, objects;
    std::string paths = "1000", from = "lights", seed = "0", color = "auto", sampler = "sobol";
};

CLI::App* add_rays(CLI::App& app, RaysOptions& options, RaysArguments& arguments);
void finish_rays(RaysOptions& options, const RaysArguments& arguments);

}  // namespace etendue
