#include "host/render/techniques.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/scene/scene_compiler.h"

namespace etendue {

std::string Techniques::backward_defines() const {
    return fmt::format(
               "#define FORWARD 0\n#define HAS_SPLATS {:d}\n#define FORWARD_ONLY {:d}\n#define BIDIRECTIONAL "
               "{:d}\n"
               "#define CONNECT_VERTICES {:d}\n#define MERGE_VERTICES {:d}\n#define BEAMS {:d}\n"
               "#define STOKES_IMAGE {:d}\n#define SEVERAL_VIEWS {:d}\n",
               forward, forward && !bidirectional, bidirectional, connect, merge, beams, stokes,
               several_views) +
           layer_defines;
}

std::string Techniques::forward_defines() const {
    return fmt::format(
               "#define FORWARD 1\n#define FORWARD_ONLY 0\n#define HAS_POWER_LEDGER {:d}\n#define "
               "BIDIRECTIONAL {:d}\n"
               "#define CONNECT_VERTICES {:d}\n#define MERGE_VERTICES {:d}\n#define BEAMS {:d}\n"
               "#define STOKES_IMAGE {:d}\n#define SEVERAL_VIEWS {:d}\n#define RECORD_RAYS {:d}\n",
               ledger, bidirectional, connect, merge, beams, stokes, several_views, ray_record) +
           layer_defines;
}

namespace {

// Runs a kernel that answers a question for each of `count` items with one word.
std::vector<uint32_t> ask(Device& device, Scene& scene, const std::string& file, const std::string& answers,
                          uint32_t count) {
    const Buffer buffer(device, uint64_t(count) * 4, answers);
    const Kernel kernel = make_color_kernel(device, scene, file, {{answers, &buffer}});
    CommandList commands(device);
    for (uint64_t first = 0; first < count; first += uint64_t(max_groups) * kernel.group_size())
        commands.dispatch(kernel,
                          std::min((count - uint32_t(first) - 1) / kernel.group_size() + 1, max_groups),
                          {{"first", uint32_t(first)}, {"count", count}});
    commands.run();
    return buffer.read_array<uint32_t>(count);
}

}  // namespace

bool find_narrow_materials(Device& device, Scene& scene) {
    if (scene.materials == 0) return false;
    if (scene.has_narrow_materials) return *scene.has_narrow_materials;
    const auto narrow =
        ask(device, scene, "kernels/measure_lobes.comp", "MaterialLobes", uint32_t(scene.materials));
    Buffer& buffer = scene.buffers.at("Materials");
    auto materials = buffer.read_array<MaterialRecord>(scene.materials);
    for (size_t i = 0; i < narrow.size(); ++i)
        if (narrow[i]) materials[i].flags |= MaterialFlag::narrow;
    buffer.write(materials.data(), materials.size() * sizeof(MaterialRecord));
    scene.has_narrow_materials =
        scene.features.bending || std::find(narrow.begin(), narrow.end(), 1u) != narrow.end();
    return *scene.has_narrow_materials;
}

CompactLights find_compact_lights(Device& device, Scene& scene) {
    CompactLights found;
    if (scene.lights == 0) return found;
    for (const uint32_t light :
         ask(device, scene, "kernels/measure_compactness.comp", "LightCompactness", uint32_t(scene.lights))) {
        found.any |= (light & 1) != 0;
        found.points |= (light & 2) != 0;
    }
    return found;
}

Techniques choose_techniques(Device& device, Scene& scene, Algorithm algorithm) {
    Techniques t;
    if (!(scene.power > 0)) return t;
    t.bidirectional = algorithm == Algorithm::bidirectional;
    t.forward = t.bidirectional || algorithm == Algorithm::forward;
    t.connect = t.bidirectional;
    t.merge = t.bidirectional && find_narrow_materials(device, scene);
    t.beams = t.merge && scene.features.even_scattering;
    return t;
}

}  // namespace etendue
