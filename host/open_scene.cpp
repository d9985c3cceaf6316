#include "host/open_scene.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <sstream>

#include "host/error.h"
#include "host/gltf/gltf.h"
#include "host/gltf/light_layers.h"
#include "host/image/atomic_file.h"
#include "host/render/light_layers.h"
#include "host/render/views.h"
#include "host/scene/scene_files.h"

namespace etendue {

ImportOptions import_options(const SceneChoice& choice) { return {choice.variant, choice.at}; }

SceneOptions scene_options(const SceneChoice& choice) {
    SceneOptions options;
    options.shaders = choice.shaders;
    options.environment = choice.environment;
    options.color = choice.color;
    options.polarization = choice.polarization;
    options.spectral_image = choice.spectral_bins > 0;
    options.samples = choice.samples;
    options.allow_class_files = choice.allow_class_files;
    options.cache_folder = default_cache_folder();
    return options;
}

OpenedScene open_scene(const SceneChoice& choice) {
    // Beside each other; what is wrong with the scene is told before what is wrong with the device.
    auto device = std::async(std::launch::async, [&] { return create_device({choice.device, false}); });
    const SceneDescription description = import_gltf(choice.scene, import_options(choice));
    OpenedScene opened;
    opened.device = device.get();
    opened.scene = compile_scene(*opened.device, description, scene_options(choice));
    opened.files = files_of(description);
    opened.files.insert(opened.files.begin(), choice.scene);
    if (!choice.environment.empty()) opened.files.push_back(choice.environment);
    opened.variants = description.variants;
    opened.animation_seconds = description.animation_seconds;
    const DeviceDescription& used = opened.device->description;
    if (used.max_loop_turns > 0)
        opened.scene.warnings.push_back(
            fmt::format("{} ends loops after {} turns: long paths, and rays past many surfaces or vertices, "
                        "may lack light",
                        used.driver, used.max_loop_turns));
    return opened;
}

const Receiver& choose_receiver(const Scene& scene, const SceneChoice& choice) {
    if (scene.receivers.empty())
        fail_input("{}: the scene has no camera and no receiver", choice.scene.string());
    if (choice.receiver.empty()) return scene.receivers.front();
    std::string names;
    for (const Receiver& receiver : scene.receivers) {
        if (receiver.name == choice.receiver) return receiver;
        names += (names.empty() ? "" : ", ") + receiver.name;
    }
    fail_input("--receiver {}: no such receiver in {}; there are: {}", choice.receiver, choice.scene.string(),
               names);
}

std::vector<const Receiver*> choose_receivers(const Scene& scene, const SceneChoice& choice) {
    const auto is_name = [&](const Receiver& receiver) { return receiver.name == choice.receiver; };
    const bool is_one = std::any_of(scene.receivers.begin(), scene.receivers.end(), is_name);
    std::vector<const Receiver*> chosen;
    if (choice.receiver == "all" && !is_one) {
        for (const Receiver& receiver : scene.receivers) chosen.push_back(&receiver);
    } else if (choice.receiver.find(',') == std::string::npos || is_one) {
        chosen.push_back(&choose_receiver(scene, choice));
    } else {
        std::istringstream names(choice.receiver);
        SceneChoice one = choice;
        while (std::getline(names, one.receiver, ',')) {
            if (one.receiver.empty()) fail_input("--receiver {}: a name is empty", choice.receiver);
            chosen.push_back(&choose_receiver(scene, one));
            if (std::count(chosen.begin(), chosen.end(), chosen.back()) > 1)
                fail_input("--receiver {}: {} stands there twice", choice.receiver, one.receiver);
        }
    }
    if (chosen.empty()) fail_input("{}: the scene has no camera and no receiver", choice.scene.string());
    if (chosen.size() > most_views)
        fail_input("--receiver {}: {} receivers; allowed: 1 to {} in one run", choice.receiver, chosen.size(),
                   most_views);
    return chosen;
}

std::string receiver_unit(const Receiver& receiver) {
    return receiver.info->pixel_unit.empty() ? "cd/m²" : receiver.info->pixel_unit;
}

std::vector<LightLayer> choose_layers(const Scene& scene, const SceneChoice& choice) {
    const std::string& asked = choice.layers;
    if (asked.empty()) return scene.layers;
    if (asked == "none") return {};
    if (asked == "lamps") return light_groups(scene);
    std::string text = asked, place = "--layers";
    if (asked.front() != '[') {
        const std::vector<std::byte> bytes = read_whole_file(asked);
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        place = asked;
    }
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded())
        fail_input("{}: is no JSON; allowed: lamps, none, a file or an array of layers", place);
    return read_layers({&json, "", &place});
}

ImageSize image_size(const Receiver& receiver, const SceneChoice& choice) {
    if (receiver.columns > 0) {
        if (choice.size)
            fail_input("--size: the receiver {} has {} x {} pixels, as its resolution says", receiver.name,
                       receiver.columns, receiver.rows);
        return {receiver.columns, receiver.rows};
    }
    if (choice.size) return *choice.size;
    const float aspect = receiver.aspect_ratio > 0 ? receiver.aspect_ratio : 1.0f;
    return {std::max(1u, uint32_t(std::lround(512 * aspect))), 512};
}

}  // namespace etendue
