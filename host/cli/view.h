// The command line of `etendue view`.
#pragma once
#include <optional>
#include <string>

#include "host/cli/shared.h"

namespace etendue {

// Arguments as text (host/cli/values.h).
struct ViewArguments {
    std::optional<std::string> passes, exposure;
    std::string curve = "srgb";
    SharedArguments shared;
};

CLI::App* add_view(CLI::App& app, ViewOptions& options, ViewArguments& arguments);
void finish_view(ViewOptions& options, const ViewArguments& arguments);

}  // namespace etendue
