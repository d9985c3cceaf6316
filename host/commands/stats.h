// --stats: what a run did, as JSON.
#pragma once
#include <filesystem>

#include "host/commands.h"
#include "host/render/renderer.h"

namespace etendue {

// Where the flux of forward rays has gone, lm; `power`: of all lights.
nlohmann::json flux_balance(const RenderCounters& counters, double power);

// `error`: the estimated relative error of the image; `setup_seconds`: before the first pass.
void write_stats(const std::filesystem::path& path, const RenderOptions& options, Device& device,
                 Scene& scene, const Renderer& renderer, const RelativeError& error, double setup_seconds);

}  // namespace etendue
