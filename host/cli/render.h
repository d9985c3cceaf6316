// The command line of `etendue render`.
#pragma once
#include <optional>
#include <string>

#include "host/cli/shared.h"

namespace etendue {

// Arguments as text (host/cli/values.h).
struct RenderArguments {
    std::optional<std::string> passes, seconds, error, forward_paths;
    SharedArguments shared;
};

CLI::App* add_render(CLI::App& app, RenderOptions& options, RenderArguments& arguments);
void finish_render(RenderOptions& options, const RenderArguments& arguments, std::string command_line);

}  // namespace etendue
