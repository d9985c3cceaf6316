#include "host/render/techniques.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/scene/scene_compiler.h"

namespace etendue {

std::string Techniques::backward_defines() const {
    return fmt::format(
        "#define FORWARD 0\n#define HAS_SPLATS {:d}\n#define FORWARD_ONLY {:d}\n#define BIDIRECTIONAL {:d}\n"
        "#define CONNECT_VERTICES {:d}\n#define MERGE_VERTICES {:d}\n",
        forward, forward && !bidirectional, bidirectional, connect, merge);
}

std::string Techniques::forward_defines() const {
    return fmt::format(
        "#define FORWARD 1\n#define FORWARD_ONLY 0\n#define BIDIRECTIONAL {:d}\n"
        "#define CONNECT_VERTICES {:d}\n#define MERGE_VERTICES {:d}\n",
        bidirectional, connect, merge);
}

bool find_narrow_materials(Device& device, Scene& scene) {
    const uint32_t count = uint32_t(scene.materials);
    if (count == 0) return false;
    const Buffer lobes(device, count * 4, "MaterialLobes");
    const Kernel kernel =
        make_kernel(device, scene, "kernels/measure_lobes.comp", {{"MaterialLobes", &lobes}});
    CommandList commands(device);
    for (uint32_t first = 0; first < count; first += max_groups * kernel.group_size())
        commands.dispatch(kernel, std::min((count - first - 1) / kernel.group_size() + 1, max_groups),
                          {{"first", first}, {"count", count}});
    commands.run();
    const auto narrow = lobes.read_array<uint32_t>(count);
    Buffer& buffer = scene.buffers.at("Materials");
    auto materials = buffer.read_array<MaterialRecord>(count);
    for (uint32_t i = 0; i < count; ++i)
        if (narrow[i]) materials[i].flags |= MaterialFlag::narrow;
    buffer.write(materials.data(), materials.size() * sizeof(MaterialRecord));
    return std::find(narrow.begin(), narrow.end(), 1u) != narrow.end();
}

Techniques choose_techniques(Device& device, Scene& scene, Algorithm algorithm) {
    Techniques t;
    if (!(scene.power > 0)) return t;
    t.bidirectional = algorithm == Algorithm::bidirectional;
    t.forward = t.bidirectional || algorithm == Algorithm::forward;
    t.connect = t.bidirectional;
    t.merge = t.bidirectional && find_narrow_materials(device, scene);
    return t;
}

}  // namespace etendue
