#include "host/render/start_media.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/error.h"

namespace etendue {

namespace {

// Light that is emitted, or received, within a crystal has no direction alone but a wave: not modelled.
void refuse_crystals(const Scene& scene, const std::vector<uint32_t>& words, size_t stride, size_t views) {
    for (size_t i = 0; i < words.size() / stride; ++i) {
        const uint32_t medium = words[i * stride];  // Surroundings::medium
        for (const ClassInfo* info : scene.classes.at(Interface::medium))
            if (info->is_crystal && medium != no_record && medium >> 24 == info->tag)
                fail_input("{} stands within the crystal {}; receivers and lights are allowed outside",
                           i < views ? "the receiver" : "light " + scene.light_names.at((i - views) / 2),
                           scene.medium_names.at(medium));
    }
}

}  // namespace

StartMedia::StartMedia(Device& device, Scene& scene, const Views& views, bool of_lights)
    : device_(device), scene_(scene), views_(views) {
    if (!scene.features.interfaces) return;
    count_ = views.count() + (of_lights ? 2 * uint32_t(scene.lights) : 0);
    const char* file = "kernels/find_start_media.comp";
    const std::string defines = views.defines() + fmt::format("#define OF_LIGHTS {:d}\n", of_lights);
    const InColors colors(scene);  // what is asked does not depend on wavelengths
    element_words_ = element_bytes(device, scene, file, defines, "StartMedia") / sizeof(uint32_t);
    media_ = Buffer(device, count_ * element_words_ * sizeof(uint32_t), "StartMedia");
    BufferTable table = views.buffers();
    table["StartMedia"] = &media_;
    kernel_ = make_kernel(device, scene, file, table, defines);
}

void StartMedia::find() {
    ask(count_);
    if (scene_.features.crystals && count_ > 0)
        refuse_crystals(scene_, media_.read_array<uint32_t>(count_ * element_words_), element_words_,
                        views_.count());
}

void StartMedia::find_of_receivers() { ask(std::min(count_, views_.count())); }

void StartMedia::ask(uint32_t count) {
    if (count == 0) return;
    CommandList commands(device_);
    for (uint64_t first = 0; first < count; first += uint64_t(max_groups) * kernel_.group_size())
        commands.dispatch(kernel_,
                          std::min((count - uint32_t(first) - 1) / kernel_.group_size() + 1, max_groups),
                          {{"first", uint32_t(first)}, {"count", count}});
    commands.run();
}

}  // namespace etendue
