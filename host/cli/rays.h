// The command line of `etendue rays`.
#pragma once
#include <optional>
#include <string>

#include "host/cli/shared.h"

namespace etendue {

// Arguments as text (host/cli/values.h).
struct RaysArguments {
    std::optional<std::string> events, objects, without;
    std::string paths = "1000", from = "lights";
    SharedArguments shared;
};

CLI::App* add_rays(CLI::App& app, RaysOptions& options, RaysArguments& arguments);
void finish_rays(RaysOptions& options, const RaysArguments& arguments);

}  // namespace etendue
