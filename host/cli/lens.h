// The command line of `etendue lens`.
#pragma once
#include <optional>
#include <string>

#include "host/commands.h"

namespace CLI {
class App;
}

namespace etendue {

// As they stand in the command line.
struct LensTexts {
    std::optional<std::string> object, rays;
};

CLI::App* add_lens(CLI::App& app, LensOptions& options, LensTexts& texts);
void finish_lens(LensOptions& options, const LensTexts& texts);

}  // namespace etendue
