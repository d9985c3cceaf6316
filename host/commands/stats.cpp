#include "host/commands/stats.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/image/atomic_file.h"
#include "host/measure/readings.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

nlohmann::json finite_or_null(double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(); }

double per_second(uint64_t count, double seconds) { return seconds > 0 ? double(count) / seconds : 0.0; }

// Backward rays carry importance: 1 a path. What leaves the scene is received by its surroundings; what is
// neither received nor lost was absorbed.
nlohmann::json importance_balance(const RenderCounters& c, double paths) {
    return {{"unit", "share of the importance that the receiver sent out"},
            {"emitted", 1.0},
            {"received", c.escaped / paths},
            {"absorbed", 1.0 - (c.escaped + c.depth_limit_lost) / paths},
            {"lost",
             {{"depth_limit", c.depth_limit_lost / paths}, {"non_finite", double(c.non_finite) / paths}}}};
}

// The flux that has come to each meter, lm; it goes on.
nlohmann::json received_by(Device& device, Scene& scene, const Renderer& renderer) {
    nlohmann::json received = nlohmann::json::object();
    for (size_t v = 0; v < renderer.views().size(); ++v)
        for (const Receiver& receiver : scene.receivers) {
            if (receiver.ref != renderer.views()[v].receiver || receiver.info->pixel_unit.empty() ||
                receiver.columns == 0)
                continue;
            const Meter meter = describe_meter(device, scene, receiver);
            if (!meter.has_extent) continue;
            const Image image = renderer.develop(false, v);
            double flux = 0;
            for (size_t i = 0; i < meter.pixels(); ++i)
                flux +=
                    meter.places[i].extent * luminance({plane(image, size_t(find_channel(image, "R")))[i],
                                                        plane(image, size_t(find_channel(image, "G")))[i],
                                                        plane(image, size_t(find_channel(image, "B")))[i]});
            received[receiver.name] = flux;
        }
    return received;
}

nlohmann::json stats(const RenderOptions& options, Device& device, Scene& scene, const Renderer& renderer,
                     const RelativeError& error, double setup_seconds) {
    nlohmann::json kernels = nlohmann::json::array(), timings = nlohmann::json::object();
    double compile_seconds = 0;
    for (const KernelReport& k : scene.kernels) {
        kernels.push_back({{"name", k.name},
                           {"from_cache", k.from_cache},
                           {"seconds", k.seconds},
                           {"spirv_bytes", k.spirv_bytes}});
        compile_seconds += k.seconds;
    }
    const RenderCounters& c = renderer.counters();
    const uint64_t rays = all_rays(c);
    for (const auto& [name, t] : renderer.timings())
        timings[name] = {{"seconds", t.seconds},
                         {"dispatches", t.dispatches},
                         {"rays_per_second", per_second(rays, t.seconds)}};
    const AlgorithmChoice& choice = renderer.choice();
    nlohmann::json films = nlohmann::json::array();
    for (const FilmView& view : renderer.views())
        for (const Receiver& receiver : scene.receivers)
            if (receiver.ref == view.receiver)
                films.push_back(
                    {{"receiver", receiver.name}, {"width", view.width}, {"height", view.height}});
    const double paths = double(renderer.passes() * pixel_count(renderer.views()));
    nlohmann::json json = {{"scene", options.scene.string()},
                           {"command", options.command_line},
                           {"version", ETENDUE_VERSION},
                           {"device", device.description.name},
                           {"driver", device.description.driver},
                           {"seed", options.seed},
                           {"width", renderer.views().front().width},
                           {"height", renderer.views().front().height},
                           {"films", films},
                           {"passes", renderer.passes()},
                           {"backward_rays", c.rays},
                           {"shadow_rays", c.shadow_rays},
                           {"forward_paths", c.forward_paths},
                           {"forward_rays", c.forward_rays},
                           {"forward_shadow_rays", c.forward_shadow_rays},
                           {"split_passes", c.split_passes},
                           {"seconds", renderer.seconds()},
                           {"setup_seconds", setup_seconds},
                           {"rays_per_second", per_second(rays, renderer.seconds())},
                           {"estimated_relative_error", finite_or_null(error.value())},
                           {"relative_error_bound", finite_or_null(error.bound())},
                           {"algorithm", algorithm_name(choice.algorithm)},
                           {"algorithm_reason", choice.reason},
                           {"forward_paths_a_pixel", c.forward_paths ? choice.forward_paths : 0.0},
                           {"pilot_seconds", choice.pilot_seconds},
                           {"schedule", schedule_name(renderer.schedule())},
                           {"polarization", scene.features.polarization},
                           {"kernels", timings},
                           {"compiled_kernels", kernels},
                           {"compile_seconds", compile_seconds},
                           {"driver_compile_seconds", renderer.warm_up_seconds()},
                           {"peak_device_memory_bytes", device.peak_bytes_allocated},
                           {"light_power_lm", scene.power},
                           {"importance_balance", importance_balance(c, paths)},
                           {"non_finite_samples", c.non_finite + c.forward_non_finite}};
    json["received_by"] = received_by(device, scene, renderer);
    json["power_balance"] = c.forward_paths ? flux_balance(c, scene.power) : json["importance_balance"];
    return json;
}

}  // namespace

// Forward rays carry power. Cameras take none: what is neither absorbed nor lost has left the scene. Russian
// roulette takes from some paths what it gives to others; what is left of that is noise.
nlohmann::json flux_balance(const RenderCounters& c, double power) {
    const double lumens = power / double(c.forward_paths);  // a unit of the counters
    const double escaped = c.forward_escaped * lumens;
    nlohmann::json absorbed_by = nlohmann::json::object();
    double told = 0;
    for (const auto& [name, flux] : c.absorbed_by) absorbed_by[name] = flux * lumens, told += flux;
    // Of passes that were made without --stats, and gone on from.
    if (std::fabs(c.absorbed - told) > 1e-4 * c.absorbed)
        absorbed_by["not told apart"] = (c.absorbed - told) * lumens;
    nlohmann::json elements = nlohmann::json::object();
    for (const auto& [name, power] : c.elements)
        elements[name] = {{"entered", power.entered * lumens},
                          {"left", power.left * lumens},
                          {"absorbed", power.absorbed * lumens}};
    return {{"unit", "lm"},
            {"emitted", c.emitted * lumens},
            {"received", 0.0},
            {"absorbed", c.absorbed * lumens},
            {"absorbed_by", absorbed_by},
            {"elements", elements},
            {"roulette", c.roulette * lumens},
            {"lost",
             {{"escaped", escaped},
              {"depth_limit", c.forward_depth_limit_lost * lumens},
              {"non_finite", c.forward_non_finite}}}};
}

void write_stats(const std::filesystem::path& path, const RenderOptions& options, Device& device,
                 Scene& scene, const Renderer& renderer, const RelativeError& error, double setup_seconds) {
    const std::string text = stats(options, device, scene, renderer, error, setup_seconds).dump(2) + "\n";
    write_atomically(path, text);
}

}  // namespace etendue
