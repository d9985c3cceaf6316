// How long what a window asks for takes, in milliseconds: the start of a scene, a move of its receiver, an
// image of another size.
//
//     live_bench SCENE.gltf [backward|forward|bidirectional]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>

#include "host/gpu/shader_compiler.h"
#include "host/render/renderer.h"
#include "host/gltf/gltf.h"
#include "host/scene/live_scene.h"

using namespace etendue;

namespace {

double milliseconds(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void report(const char* what, double ms) { fmt::print("{:<44} {:8.1f} ms\n", what, ms); }

// The median of several times.
void report_often(const char* what, const std::function<void()>& work) {
    std::vector<double> times;
    for (int i = 0; i < 7; ++i) times.push_back(milliseconds(work));
    std::sort(times.begin(), times.end());
    report(what, times[times.size() / 2]);
}

// The value as a little more than it is; null where it is no number or colour.
nlohmann::json nudged(const LiveParameter& p) {
    const auto more = [&](double x) { return p.info.in_range(1.01 * x + 0.01) ? 1.01 * x + 0.01 : 0.9 * x; };
    if (p.value.is_number() && p.info.member.type != "uint") return more(p.value.get<double>());
    if (!p.value.is_array() || !p.value[0].is_number()) return nullptr;
    nlohmann::json result = nlohmann::json::array();
    for (const auto& x : p.value) result.push_back(more(x.get<double>()));
    return result;
}

void report_edits(Device& device, LiveScene& live, const RenderSettings& settings) {
    std::set<std::pair<LiveObject::Part, std::string>> seen;
    for (const LiveObject& object : live.objects())
        for (LiveParameter p : object.parameters) {
            if (nudged(p).is_null() || object.part == LiveObject::Part::receiver) continue;
            if (!seen.emplace(object.part, object.class_name).second) break;
            for (int turn = 0; turn < 2; ++turn) {  // the first may compile
                p.value = nudged(p);
                std::shared_ptr<Scene> next;
                std::unique_ptr<Renderer> renderer;
                const double scene_ms =
                    milliseconds([&] { next = live.set_parameter(object, p.info.member.name, p.value); });
                const double renderer_ms =
                    milliseconds([&] { renderer = std::make_unique<Renderer>(device, *next, settings); });
                const auto compiled = std::count_if(next->kernels.begin(), next->kernels.end(),
                                                    [](const KernelReport& k) { return !k.from_store; });
                live.accept();
                report(fmt::format("{} {}: scene ({} new kernels)", object.class_name, p.info.member.name,
                                   compiled)
                           .c_str(),
                       scene_ms);
                report("    and renderer, 512 x 512", renderer_ms);
            }
            break;
        }
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 2) {
        fmt::print(stderr, "usage: live_bench SCENE [backward|forward|bidirectional]\n");
        return 2;
    }
    RenderSettings settings;
    settings.algorithm = Algorithm::backward;
    for (const Algorithm a : {Algorithm::forward, Algorithm::bidirectional})
        if (argc > 2 && std::string(argv[2]) == algorithm_name(a)) settings.algorithm = a;
    SceneDescription description;
    std::unique_ptr<Device> device;
    Scene scene;
    std::unique_ptr<Renderer> renderer;
    SceneOptions options;
    options.cache_folder = default_cache_folder();
    double total = 0;
    const auto stage = [&](const char* what, const std::function<void()>& work) {
        const double ms = milliseconds(work);
        total += ms;
        report(what, ms);
    };
    stage("import", [&] { description = import_gltf(argv[1]); });
    stage("device", [&] { device = create_device(); });
    stage("scene", [&] { scene = compile_scene(*device, description, options); });
    settings.receiver = scene.receivers.at(0).ref;
    stage("renderer", [&] { renderer = std::make_unique<Renderer>(*device, scene, settings); });
    stage("first pass of 512 x 512", [&] { renderer->render_passes(1); });
    report("all", total);

    const Receiver receiver = scene.receivers[0];
    const auto move = [&] { move_receiver(scene, 0, receiver.world_from_local, receiver.parameters); };
    report_often("move the receiver", move);
    report_often("move the receiver, restart 512 x 512", [&] { move(), renderer->restart(1); });
    report_often("restart 512 x 512", [&] { renderer->restart(1); });
    settings.choice = renderer->choice();
    for (const uint32_t size : {128u, 512u, 1024u}) {
        settings.width = settings.height = size;
        std::unique_ptr<Renderer> other;
        report_often(fmt::format("another renderer, {0} x {0}", size).c_str(),
                     [&] { other.reset(), other = std::make_unique<Renderer>(*device, scene, settings); });
        other->render_passes(1);
        report_often(fmt::format("restart and a pass, {0} x {0}", size).c_str(),
                     [&] { other->restart(1), other->render_passes(1); });
    }
    settings.width = settings.height = 512;
    LiveScene live(*device, argv[1], options);
    report_edits(*device, live, settings);
    std::shared_ptr<Scene> next;
    report_often("the file read again", [&] { next = live.reload(); });
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "live_bench: {}\n", error.what());
    return 1;
}
