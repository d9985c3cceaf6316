#include "host/preview/background_pilot.h"

#include <sys/resource.h>
#include <unistd.h>

#include "host/error.h"
#include "host/open_scene.h"
#include "host/render/automatic.h"

namespace etendue {
namespace {

constexpr int more_niceness = 5;       // than the renderer's
constexpr uint32_t small_pixels = 64;  // along both sides, of the renderer that only compiles

}  // namespace

BackgroundPilot::BackgroundPilot(const SceneChoice& options, const RenderSettings& settings, size_t index,
                                 const Receiver& receiver) {
    thread_ = std::thread([this, options, settings, index, receiver] {
        const auto thread = id_t(gettid());
        setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + more_niceness);
        try {
            run(options, settings, index, receiver);
        } catch (const std::exception& error) {
            choice_ = {};
            choice_.reason = std::string("the pilot failed: ") + error.what();
        }
        ended_ = true;
    });
}

BackgroundPilot::~BackgroundPilot() {
    stop_ = true;
    thread_.join();
}

void BackgroundPilot::run(const SceneChoice& options, RenderSettings settings, size_t index,
                          const Receiver& receiver) {
    const auto device = create_device({options.device, false});
    Scene scene =
        compile_scene(*device, import_gltf(options.scene, import_options(options)), scene_options(options));
    if (index >= scene.receivers.size()) fail_input("the scene file has changed");
    move_receiver(scene, index, receiver.world_from_local, receiver.parameters);
    settings.receiver = scene.receivers[index].ref;
    choice_ = choose_algorithm(*device, scene, settings, [this] { return stop_.load(); });
    if (stop_ || choice_.algorithm == Algorithm::backward) return;
    settings.choice = choice_;
    settings.width = settings.height = small_pixels;
    const Renderer compiles(*device, scene, settings);
    for (const KernelReport& kernel : scene.kernels)
        if (!kernel.spirv.empty()) programs_.push_back({kernel.key, kernel.spirv});
}

}  // namespace etendue
