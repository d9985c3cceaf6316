#include "host/render/start_media.h"

#include <algorithm>

namespace etendue {

StartMedia::StartMedia(Device& device, Scene& scene, bool of_lights) : device_(device) {
    if (!scene.features.interfaces) return;
    count_ = of_lights ? 1 + 2 * uint32_t(scene.lights) : 1;
    const char* file = "kernels/find_start_media.comp";
    const std::string defines = of_lights ? "#define OF_LIGHTS 1\n" : "#define OF_LIGHTS 0\n";
    const InColors colors(scene);  // what is asked does not depend on wavelengths
    media_ = Buffer(device, count_ * element_bytes(device, scene, file, defines, "StartMedia"), "StartMedia");
    kernel_ = make_kernel(device, scene, file, {{"StartMedia", &media_}}, defines);
}

void StartMedia::find(uint32_t receiver, float film_aspect) { ask(count_, receiver, film_aspect); }

void StartMedia::find_of_receiver(uint32_t receiver, float film_aspect) {
    ask(std::min(count_, 1u), receiver, film_aspect);
}

void StartMedia::ask(uint32_t count, uint32_t receiver, float film_aspect) {
    if (count == 0) return;
    CommandList commands(device_);
    for (uint64_t first = 0; first < count; first += uint64_t(max_groups) * kernel_.group_size())
        commands.dispatch(kernel_,
                          std::min((count - uint32_t(first) - 1) / kernel_.group_size() + 1, max_groups),
                          {{"first", uint32_t(first)},
                           {"count", count},
                           {"receiver", receiver},
                           {"film_aspect", film_aspect}});
    commands.run();
}

}  // namespace etendue
