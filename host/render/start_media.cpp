#include "host/render/start_media.h"

#include <algorithm>

namespace etendue {

Buffer find_start_media(Device& device, Scene& scene, uint32_t receiver, float film_aspect, bool of_lights) {
    if (!scene.features.interfaces) return {};
    const uint32_t count = of_lights ? 1 + 2 * uint32_t(scene.lights) : 1;
    Buffer media(device, uint64_t(count) * (scene.features.body_count > 0 ? 12 : 4), "StartMedia");
    const Kernel kernel =
        make_color_kernel(device, scene, "kernels/find_start_media.comp", {{"StartMedia", &media}},
                          of_lights ? "#define OF_LIGHTS 1\n" : "#define OF_LIGHTS 0\n");
    CommandList commands(device);
    for (uint64_t first = 0; first < count; first += uint64_t(max_groups) * kernel.group_size())
        commands.dispatch(kernel,
                          std::min((count - uint32_t(first) - 1) / kernel.group_size() + 1, max_groups),
                          {{"first", uint32_t(first)},
                           {"count", count},
                           {"receiver", receiver},
                           {"film_aspect", film_aspect}});
    commands.run();
    return media;
}

}  // namespace etendue
