#include "host/commands/showcases.h"

#include <unistd.h>

#include <chrono>

#include "host/embedded_files.h"
#include "host/error.h"
#include "host/gltf/gltf.h"
#include "host/image/atomic_file.h"
#include "host/image/png.h"
#include "host/interrupt.h"
#include "host/open_scene.h"
#include "host/render/renderer.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr uint32_t pixels = 240;        // rows and columns of a picture
constexpr double batch_seconds = 0.25;  // of work between two looks at the interrupt

void merge(json& into, const json& from) {
    if (into.is_object() && from.is_object())
        for (const auto& [key, value] : from.items()) merge(into[key], value);
    else if (into.is_array() && from.is_array())
        into.insert(into.end(), from.begin(), from.end());
    else
        into = from;
}

// Empty where it was interrupted. `status` counts on from where it stands.
Png render_picture(Renderer& renderer, uint32_t passes, Clock::time_point start, RenderStatus& status,
                   Progress& progress) {
    const RenderStatus before = status;
    while (renderer.passes() < passes) {
        if (interrupted()) return {};
        const uint64_t left = passes - renderer.passes();
        renderer.render_passes(uint32_t(std::min<uint64_t>(renderer.passes_in(batch_seconds), left)));
        status.passes = before.passes + renderer.passes();
        status.rays = before.rays + double(all_rays(renderer.counters()));
        status.seconds = std::chrono::duration<double>(Clock::now() - start).count();
        show_progress(progress, status);
    }
    return encode_png(renderer.develop(false));
}

}  // namespace

Showcases::Showcases() {
    std::string name = (fs::temp_directory_path() / "etendue-XXXXXX").string();
    if (!mkdtemp(name.data())) fail_input("{}: no folder for scenes can be made there", name);
    folder_ = name;
    for (const EmbeddedFile& file : embedded_showcases())
        write_atomically(folder_ / fs::path(file.name).filename(), file.bytes);
}

Showcases::~Showcases() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

fs::path Showcases::write_scene(const ClassInfo& info) const {
    const json example = json::parse(info.example, nullptr, false);
    if (!example.is_object()) fail_input("{}: the example is no JSON object", info.file);
    const std::string showcase = fmt::format("manual/{}.gltf", interface_info(info.interface).name);
    json scene;
    for (const EmbeddedFile& file : embedded_showcases())
        if (file.name == showcase) scene = json::parse(file.bytes);
    if (scene.is_null()) fail_input("{}: there is no scene for examples: scenes/{}", info.file, showcase);
    merge(scene, example);
    const fs::path path = folder_ / (info.name + " (example).gltf");
    write_atomically(path, scene.dump(1));
    return path;
}

std::map<const ClassInfo*, Png> render_examples(Device& device, const std::vector<const ClassInfo*>& classes,
                                                const ClassesOptions& options, Progress& progress) {
    std::vector<const ClassInfo*> shown;
    for (const ClassInfo* info : classes)
        if (!info->example.empty()) shown.push_back(info);
    const Showcases showcases;
    const auto start = Clock::now();
    RenderStatus status;
    status.passes_goal = uint64_t(options.passes) * shown.size();
    std::map<const ClassInfo*, Png> pictures;
    for (const ClassInfo* info : shown) {
        show_note(progress, fmt::format("{} {}", interface_info(info->interface).name, info->name));
        SceneChoice choice;
        choice.scene = showcases.write_scene(*info), choice.shaders = options.shaders;
        Scene scene = compile_scene(device, import_gltf(choice.scene), scene_options(choice));
        for (const std::string& warning : scene.warnings) show_note(progress, "warning: " + warning);
        RenderSettings settings;
        settings.width = settings.height = pixels;
        settings.receiver = choose_receiver(scene, choice).ref;
        // Backward rays compile fastest, but seldom meet narrow beams in fog.
        settings.algorithm =
            info->interface == Interface::phase ? Algorithm::bidirectional : Algorithm::backward;
        Renderer renderer(device, scene, settings);
        Png picture = render_picture(renderer, options.passes, start, status, progress);
        if (picture.empty()) break;
        pictures[info] = std::move(picture);
    }
    finish_progress(progress, status);
    return pictures;
}

}  // namespace etendue
