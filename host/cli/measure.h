// The command line of `etendue measure`.
#pragma once
#include <optional>
#include <string>

#include "host/cli/shared.h"

namespace etendue {

// Arguments as text (host/cli/values.h).
struct MeasureArguments {
    std::optional<std::string> passes, seconds, error, forward_paths, points, glare_from;
    std::string receivers = "all", error_of = "mean";
    SharedArguments shared;
};

CLI::App* add_measure(CLI::App& app, MeasureOptions& options, MeasureArguments& arguments);
void finish_measure(MeasureOptions& options, const MeasureArguments& arguments, std::string command_line);

}  // namespace etendue
