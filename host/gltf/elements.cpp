// Optical elements: nodes that hold another scene of the file, as a black box.
#include <algorithm>
#include <map>

#include "host/geometry/turn.h"
#include "host/gltf/import.h"

namespace etendue {
namespace {

constexpr size_t max_elements = size_t(1) << 20;

void check_holds_not_itself(const GltfImport& import, uint32_t element, uint32_t root_scene) {
    const std::optional<uint32_t> scene = import.elements[element].scene;
    if (!scene) return;
    for (uint32_t i = import.scene.elements[element].parent;; i = import.scene.elements[i - 1].parent) {
        if (*scene == (i == 0 ? root_scene : import.elements[i - 1].scene))
            fail_at(member(import.elements[element].at, "scene"),
                    "scene {} holds itself; allowed: another scene", *scene);
        if (i == 0) return;
    }
}

// A class whose contents are made of its parameters.
bool is_placed(const std::string& name) {
    return name == "microstructure" || name == "lens_system" || name == "grating";
}

// What an element holds, as a new content.
void place_content(GltfImport& import, uint32_t element) {
    SceneDescription& scene = import.scene;
    const size_t instances = scene.instances.size(), shapes = scene.shapes.size(),
                 lights = scene.lights.size(), receivers = scene.receivers.size();
    const JsonAt at = import.elements[element].at;
    import.content_root = glm::dmat4(import.elements[element].scale);
    import.holder = element + 1;
    scene.contents.push_back({{}, at.pointer});
    if (const auto held = import.elements[element].scene) {
        scene.contents.back().boundary = read_boundary(import, at);
        place_nodes(import, *held);
    } else if (const std::string& name = text_value(member(at, "class")); name == "microstructure") {
        place_microstructure(import, at);
    } else if (name == "grating") {
        place_grating(import, at);
    } else {
        place_lens_system(import, at);
    }
    const uint32_t content = uint32_t(scene.contents.size());
    const auto name = [&](auto& objects, size_t first) {
        for (size_t i = first; i < objects.size(); ++i) objects[i].content = content;
    };
    name(scene.instances, instances), name(scene.shapes, shapes);
    name(scene.lights, lights), name(scene.receivers, receivers);
}

bool shines_or_receives(const SceneDescription& scene, uint32_t content) {
    const auto is_held = [&](const auto& object) { return object.content == content; };
    const auto emits = [&](uint32_t material) { return scene.materials[material].emission.has_value(); };
    return std::ranges::any_of(scene.lights, is_held) || std::ranges::any_of(scene.receivers, is_held) ||
           std::ranges::any_of(scene.shapes,
                               [&](const PlacedObject& s) { return is_held(s) && emits(s.material); }) ||
           std::ranges::any_of(scene.instances, [&](const MeshInstance& i) {
               return is_held(i) && emits(scene.meshes[i.mesh].material);
           });
}

}  // namespace

void read_element(GltfImport& import, const JsonAt& at, const std::string& name,
                  const glm::dmat4& parent_from_local) {
    const JsonAt class_at = member(at, "class");
    const bool holds_scene = text_value(class_at) == "subscene";
    if (holds_scene)
        only_members(at, {"class", "scene", "boundary"});
    else if (!is_placed(text_value(class_at)))
        fail_at(class_at,
                "there is no element class '{}'; allowed: subscene, microstructure, lens_system, grating",
                text_value(class_at));
    if (import.scene.elements.size() == max_elements)
        fail_at(at, "the scene has more than {} elements", max_elements);
    const Parts parts = parted(glm::dmat3(parent_from_local));
    PlacedElement element{name, at.pointer, 0, import.holder, glm::dmat4(parts.turn)};
    element.parent_from_local[3] = parent_from_local[3];
    import.scene.elements.push_back(element);
    std::optional<uint32_t> scene;
    if (holds_scene) scene = index_value(member(at, "scene"), array_size(import.root, "scenes"), "/scenes");
    // In the digits of floats, so that what turning leaves of them makes no two scales of one.
    glm::dmat3 scale = glm::dmat3(glm::mat3(parts.rest));
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (r > c || std::abs(scale[c][r]) < 1e-9 * std::abs(scale[c][c])) scale[c][r] = 0;
    import.elements.push_back({scene, scale, at});
}

void load_elements(GltfImport& import, uint32_t root_scene) {
    SceneDescription& scene = import.scene;
    if (scene.elements.empty()) return;
    std::map<std::pair<std::string, std::vector<double>>, uint32_t> known;  // contents that may be shared
    for (uint32_t i = 0; i < scene.elements.size(); ++i) {
        check_holds_not_itself(import, i, root_scene);
        const ElementImport& element = import.elements[i];
        std::vector<double> scale(&element.scale[0][0], &element.scale[0][0] + 9);
        nlohmann::json what = *element.at;
        auto found = known.find({what.dump(), scale});
        if (found == known.end()) {
            const size_t elements = scene.elements.size();
            place_content(import, i);
            const uint32_t content = uint32_t(scene.contents.size()) - 1;
            scene.elements[i].content = content;
            if (elements == scene.elements.size() && !shines_or_receives(scene, content + 1))
                known[{what.dump(), scale}] = content;
        } else {
            scene.elements[i].content = found->second;
        }
    }
    MaterialDescription boundary;
    boundary.name = "boundary";
    boundary.surface = {"absorber", nlohmann::json::object(), "/materials"};
    scene.boundary_material = uint32_t(scene.materials.size());
    scene.materials.push_back(boundary);
}

}  // namespace etendue
