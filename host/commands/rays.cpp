// etendue rays: paths of light as files, for those who want to see where it goes.
#include <fmt/core.h>

#include <numeric>

#include "host/error.h"
#include "host/open_scene.h"
#include "host/render/path_export.h"

namespace etendue {
namespace {

constexpr uint32_t most_passes = 64;  // over which wavelengths are spread

PathFilter filter_of(const RaysOptions& options) {
    PathFilter filter;
    filter.objects = {options.objects.begin(), options.objects.end()};
    filter.without = {options.without.begin(), options.without.end()};
    for (const std::string& name : options.events) {
        PathEvent event = PathEvent::emitted;
        while (name != event_name(event)) {
            if (event == PathEvent::escaped)
                fail_input(
                    "--events {}: allowed: emitted, reflected, refracted, straight, scattered, "
                    "entered, left, bent, absorbed, escaped",
                    name);
            event = PathEvent(int(event) + 1);
        }
        filter.events.insert(event);
    }
    return filter;
}

}  // namespace

int rays_command(const RaysOptions& options) {
    check_path_file(options.output);
    const PathFilter filter = filter_of(options);
    OpenedScene opened = open_scene(options);
    Scene& scene = opened.scene;
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "warning: {}\n", printable(warning));
    const Receiver& receiver = choose_receiver(scene, options);
    RenderSettings settings;
    settings.receiver = receiver.ref;
    settings.width = image_size(receiver, options).width;
    settings.height = image_size(receiver, options).height;
    settings.seed = uint32_t(options.seed ^ (options.seed >> 32));

    // All paths of a pass carry the same wavelengths.
    const uint32_t passes = scene.features.spectral ? std::min(options.paths, most_passes) : 1;
    const uint32_t a_pass = (options.paths + passes - 1) / passes;
    const uint64_t pixels = uint64_t(settings.width) * settings.height;
    settings.forward_paths = (a_pass + 0.5) / double(pixels);
    PathRecorder recorder(*opened.device, scene, settings, !options.backward, 64, options.inside);
    std::vector<RecordedPath> kept;
    for (uint32_t pass = 0, done = 0; done < options.paths; ++pass) {
        std::vector<uint32_t> indices(std::min(a_pass, options.paths - done));
        std::iota(indices.begin(), indices.end(), 0u);
        if (options.backward)  // spread over the image
            for (uint32_t& i : indices) i = uint32_t(uint64_t(done + i) * pixels / options.paths);
        for (RecordedPath& path : recorder.record(pass, indices))
            if (filter.keeps(path)) kept.push_back(std::move(path));
        done += uint32_t(indices.size());
    }
    write_paths(options.output, kept);
    fmt::print("{} of {} paths\n", kept.size(), options.paths);
    return int(ExitCode::done);
}

}  // namespace etendue
