#include "host/render/automatic.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "host/image/compare.h"
#include "host/render/techniques.h"

namespace etendue {
namespace {

constexpr uint32_t pilot_pixels = 32;  // along the longer side
constexpr uint32_t pilot_passes = 64;
// Rare bright samples make a pilot a noisy judge, by a factor of two either way: forward rays must win
// clearly.
constexpr double clear_win = 0.5;
constexpr double false_alarm = 1e-3;  // of calling images different that are not
// A pass of fewer leaves the device idle.
constexpr double least_forward_paths = 1 << 14;
constexpr double most_paths = 16, least_paths = 0.25;  // forward paths a pixel

struct Pilot {
    Image image;
    double variance = 0;  // mean squared relative error of one pass
    double seconds = 0;   // of one pass
};

using Interrupt = std::function<bool()>;

Pilot run_pilot(Device& device, Scene& scene, RenderSettings settings, Algorithm algorithm, double paths,
                const Interrupt& interrupt) {
    const double scale = double(pilot_pixels) / std::max(settings.width, settings.height);
    settings.width = std::max(1u, uint32_t(settings.width * std::min(1.0, scale)));
    settings.height = std::max(1u, uint32_t(settings.height * std::min(1.0, scale)));
    settings.algorithm = algorithm;
    settings.forward_paths = paths;
    settings.spectral_bins = 0;
    settings.stokes = false;
    settings.layers.clear();
    settings.ledger = false;
    settings.seed = ~settings.seed;  // independent of the image to come
    Renderer renderer(device, scene, settings);
    for (uint32_t i = 0; i < pilot_passes; ++i) {
        if (interrupt && interrupt()) return {};
        renderer.render_passes(1);
    }
    Pilot pilot;
    pilot.image = renderer.develop();
    const double error = estimated_relative_error(pilot.image);
    pilot.variance = error * error * pilot_passes;
    pilot.seconds = renderer.seconds() / pilot_passes;
    return pilot;
}

bool agree(const Image& a, const Image& b) {
    for (uint32_t tile : {1u, 8u, pilot_pixels}) {
        const auto test = z_test(a, b, {"R", "G", "B"}, tile, false_alarm);
        if (test && !test->passes) return false;
    }
    return true;
}

// variance = a + b / paths, seconds = c + d paths: their product is least where paths² = b c / (a d).
double best_paths(const Pilot& one, const Pilot& four) {
    const double b = std::max(0.0, (one.variance - four.variance) * 4 / 3);
    const double a = std::max(one.variance - b, 0.01 * one.variance);
    const double d = std::max((four.seconds - one.seconds) / 3, 0.01 * one.seconds);
    const double c = std::max(one.seconds - d, 0.01 * one.seconds);
    const double exponent = std::round(0.5 * std::log2(std::max(b * c / (a * d), 1e-9)));
    return std::clamp(std::exp2(exponent), least_paths, most_paths);
}

}  // namespace

bool deserves_pilot(double backward_paths) {
    return 10.0 * 3 * pilot_passes * pilot_pixels * pilot_pixels <= backward_paths;
}

AlgorithmChoice choose_both_ways(const std::vector<FilmView>& views, std::string reason) {
    return {Algorithm::bidirectional, std::max(1.0, least_forward_paths / double(pixel_count(views))),
            std::move(reason)};
}

std::optional<AlgorithmChoice> choose_without_pilot(Device& device, Scene& scene,
                                                    const std::vector<FilmView>& views) {
    const auto backward = [](std::string reason) {
        return AlgorithmChoice{Algorithm::backward, 1, std::move(reason)};
    };
    if (!(scene.power > 0)) return backward("no light");
    if (!scene.unmet_lights.empty())
        return choose_both_ways(
            views, fmt::format("forward rays alone bring the light of {}", scene.unmet_lights[0]));
    for (const Receiver& receiver : scene.receivers)
        for (const FilmView& view : views)
            if (receiver.ref == view.receiver && receiver.info->is_far)
                return choose_both_ways(views, "from far away backward rays seldom hit a lamp");
            else if (receiver.ref == view.receiver && receiver.info->records_rays)
                return choose_both_ways(views, "forward rays alone are recorded");
    const bool narrow = find_narrow_materials(device, scene);
    const char* const matte = "no surface is smooth or nearly so";
    if (!narrow && !scene.features.scattering) return backward(matte);
    const CompactLights lights = find_compact_lights(device, scene);
    if (!narrow && !lights.points) return backward(matte);
    if (lights.any && views.size() > 1) return choose_both_ways(views, "backward rays alone may miss light");
    if (lights.any) return {};
    return backward("no light is compact");
}

std::string missed_light(const Scene& scene, Algorithm algorithm) {
    if (algorithm != Algorithm::backward || scene.unmet_lights.empty()) return {};
    return fmt::format(
        "backward rays find no light of {}: it is left out; --algorithm forward or bidirectional brings it",
        fmt::join(scene.unmet_lights, ", "));
}

AlgorithmChoice choose_algorithm(Device& device, Scene& scene, const RenderSettings& settings,
                                 const Interrupt& interrupt) {
    if (const auto choice = choose_without_pilot(device, scene, all_views(settings))) return *choice;
    const auto start = std::chrono::steady_clock::now();
    const auto pilot = [&](Algorithm algorithm, double paths) {
        return run_pilot(device, scene, settings, algorithm, paths, interrupt);
    };
    AlgorithmChoice choice;
    const Pilot backward = pilot(Algorithm::backward, 1), one = pilot(Algorithm::bidirectional, 1);
    if (interrupt && interrupt()) return choice;
    const bool agreed = agree(backward.image, one.image);
    const double ratio = one.variance * one.seconds / (backward.variance * backward.seconds);
    const std::string measured = fmt::format("error² x time of bidirectional is {:.3g} of backward", ratio);
    if (agreed && !(ratio < clear_win)) {
        choice.reason = "a pilot agrees both ways, and " + measured;
    } else {
        const Pilot four = pilot(Algorithm::bidirectional, 4);
        if (interrupt && interrupt()) return choice;
        choice.algorithm = Algorithm::bidirectional;
        choice.forward_paths = best_paths(one, four);
        choice.reason = agreed ? "in a pilot " + measured : "in a pilot backward rays alone missed light";
    }
    choice.pilot_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return choice;
}

}  // namespace etendue
