// Options that several commands have in common.
#pragma once
#include <initializer_list>
#include <optional>
#include <string>

#include "host/commands.h"

namespace CLI {
class App;
}

namespace etendue {

// Arguments as text (host/cli/values.h).
struct SharedArguments {
    std::optional<std::string> size, at, spectral_bins;
    std::string algorithm = "auto", vertex_memory = "256", color = "auto", polarization = "auto",
                schedule = "auto", sampler = "sobol", seed = "0";
};

struct SharedOption {
    const char* name;  // without dashes
    const char* text = "As for render";
};

// Adds those of variant, receiver, environment, device, shaders, class files and the members of
// SharedArguments, in that order of the help.
void add_shared(CLI::App& command, SceneChoice& options, SharedArguments& arguments,
                std::initializer_list<SharedOption> wanted);
// Size, moment, bins, colours and samples; the rest is for commands to take.
void finish_shared(SceneChoice& options, const SharedArguments& arguments);

}  // namespace etendue
