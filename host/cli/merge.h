// The command line of `etendue merge`.
#pragma once
#include <optional>
#include <string>

#include "host/commands.h"

namespace CLI {
class App;
}

namespace etendue {

CLI::App* add_merge(CLI::App& app, MergeOptions& options, std::optional<std::string>& passes);
void finish_merge(MergeOptions& options, const std::optional<std::string>& passes, std::string command_line);

}  // namespace etendue
