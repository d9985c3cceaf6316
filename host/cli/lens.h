// The command line of `etendue lens`.
#pragma once
#include <optional>
#include <string>

#include "host/commands.h"

namespace CLI {
class App;
}

namespace etendue {

CLI::App* add_lens(CLI::App& app, LensOptions& options, std::optional<std::string>& rays);
void finish_lens(LensOptions& options, const std::optional<std::string>& rays);

}  // namespace etendue
