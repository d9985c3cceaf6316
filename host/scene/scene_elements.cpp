// Optical elements: their frames, and what is in which.
#include "host/error.h"
#include "host/scene/scene_compiler.h"
#include "host/scene/scene_files.h"

namespace etendue {
namespace {

// Twin of struct Element in shaders/features/elements.glsl.
struct ElementRecord {
    glm::vec3 parent_from_local[4], local_from_parent[4];  // columns
    uint32_t parent, header, first_light, light_count;
};

}  // namespace

// Of what holds lights, receivers or elements there is one. As on the device: 0 = the scene.
uint32_t SceneCompiler::element_of(uint32_t content) const {
    if (content == 0) return 0;
    const auto found = std::ranges::find(in_.elements, content - 1, &PlacedElement::content);
    return uint32_t(found - in_.elements.begin()) + 1;
}

// Places that media have are those of the frame that they are in: either of the scene or of elements.
bool SceneCompiler::fills_elements(const MediumDescription& medium) const {
    bool in_scene = false, in_element = false;
    const auto look = [&](uint32_t material, uint32_t content) {
        const MaterialDescription& m = in_.materials[material];
        if (m.inside == medium.name || m.outside == medium.name)
            (content == 0 ? in_scene : in_element) = true;
    };
    for (const MeshInstance& i : in_.instances) look(in_.meshes[i.mesh].material, i.content);
    for (const PlacedObject& s : in_.shapes) look(s.material, s.content);
    return in_element && !in_scene;
}

// By index in lights_, before they are sorted.
uint32_t SceneCompiler::element_of_light(uint32_t i) const {
    if (i >= first_area_light_)
        return element_of(memory_.world.contents[area_primitives_[i - first_area_light_]]);
    const size_t infinite = first_area_light_ - in_.lights.size();
    return i < infinite ? 0 : element_of(in_.lights[i - infinite].content);
}

void SceneCompiler::upload_elements() {
    if (in_.elements.empty()) return;
    out_.elements = in_.elements;
    std::vector<ElementRecord> records(in_.elements.size() + 1);
    for (size_t i = 0; i < records.size(); ++i) {
        ElementRecord& record = records[i];
        glm::dmat4 parent_from_local(1.0);
        record.header = memory_.world.headers[0];
        if (i > 0) {
            const PlacedElement& element = in_.elements[i - 1];
            record.parent = element.parent;
            record.header = memory_.world.headers[element.content + 1];
            parent_from_local = element.parent_from_local;
            if (element.parent == 0) parent_from_local[3] -= glm::dvec4(out_.center, 0);
        }
        const TransformRecord transform = transform_record(parent_from_local);
        std::ranges::copy(transform.world_from_local, record.parent_from_local);
        std::ranges::copy(transform.local_from_world, record.local_from_parent);
    }
    for (uint32_t light = 0; light < light_elements_.size(); ++light) {
        ElementRecord& record = records[light_elements_[light]];
        if (record.light_count++ == 0) record.first_light = light;
    }
    upload("Elements", records);
    upload("LightElements", light_elements_);
}

}  // namespace etendue
