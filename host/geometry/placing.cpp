#include "host/geometry/placing.h"

#include "host/error.h"
#include "host/scene/records.h"
#include "host/scene/scene_files.h"

namespace etendue {

Placing::Placing(const SceneDescription& scene, const std::vector<Box>& shape_bounds,
                 const std::vector<Box>& mesh_bounds)
    : scene_(scene), held_(scene.contents.size() + 1) {
    const auto grow = [&](uint32_t content, const glm::dmat4& m, const Box& box) {
        for (int corner = 0; corner < 8 && !box.empty(); ++corner)
            held_[content].extent.grow(m * glm::dvec4(corner_of(box, corner), 1));
    };
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const MeshInstance& instance = scene.instances[i];
        held_[instance.content].instances.push_back(i);
        grow(instance.content, instance.world_from_local, mesh_bounds[instance.mesh]);
    }
    for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
        held_[scene.shapes[i].content].shapes.push_back(i);
        grow(scene.shapes[i].content, scene.shapes[i].world_from_local, shape_bounds[i]);
    }
    // Contents stand behind those that hold them.
    for (uint32_t i = uint32_t(scene.elements.size()); i-- > 0;) {
        const PlacedElement& element = scene.elements[i];
        Held& held = held_[element.content + 1];
        const ElementContent& content = scene.contents[element.content];
        if (held.boundary.empty())
            held.boundary = content.boundary.empty() ? box_around(held.extent) : mesh_boundary(content);
        if (held.boundary.empty())
            fail_input(
                "{}: the element holds nothing that has an extent; allowed: a scene with geometry, or a "
                "boundary that is a mesh",
                message_place(scene, element.where));
        Held& parent = held_[element.parent == 0 ? 0 : scene.elements[element.parent - 1].content + 1];
        parent.elements.push_back(i);
        for (const Corners& triangle : held.boundary)
            for (const glm::dvec3& p : triangle)
                parent.extent.grow(element.parent_from_local * glm::dvec4(p, 1));
    }
}

glm::dvec3 Placing::center() const {
    const Extent& extent = held_[0].extent;
    return extent.empty() ? glm::dvec3(0) : 0.5 * (extent.lo + extent.hi);
}

// A little larger than what it holds, so that nothing lies on it.
std::vector<Placing::Corners> Placing::box_around(const Extent& extent) {
    if (extent.empty()) return {};
    const glm::dvec3 size = extent.hi - extent.lo, far = glm::max(glm::abs(extent.lo), glm::abs(extent.hi));
    const glm::dvec3 margin(1e-5 * std::max({size.x, size.y, size.z}) +
                            1e-6 * std::max({far.x, far.y, far.z}));
    const glm::dvec3 corner[2] = {extent.lo - margin, extent.hi + margin};
    std::vector<Corners> triangles;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const auto at = [&](int u, int v) {
                glm::dvec3 p;
                p[axis] = corner[side][axis];
                p[(axis + 1) % 3] = corner[u][(axis + 1) % 3];
                p[(axis + 2) % 3] = corner[v][(axis + 2) % 3];
                return p;
            };
            const glm::dvec3 a = at(0, 0), b = at(side, 1 - side), c = at(1, 1), d = at(1 - side, side);
            triangles.push_back({a, c, d});
            triangles.push_back({a, b, c});
        }
    return triangles;
}

std::vector<Placing::Corners> Placing::mesh_boundary(const ElementContent& content) const {
    std::vector<Corners> triangles;
    for (const MeshInstance& instance : content.boundary) {
        const MeshDescription& mesh = scene_.meshes[instance.mesh];
        const glm::dmat4& m = instance.world_from_local;
        const bool is_mirrored = glm::determinant(glm::dmat3(m)) < 0;
        for (glm::uvec3 t : mesh.triangles) {
            if (is_mirrored) std::swap(t.y, t.z);
            triangles.push_back({m * glm::dvec4(mesh.positions[t.x], 1),
                                 m * glm::dvec4(mesh.positions[t.y], 1),
                                 m * glm::dvec4(mesh.positions[t.z], 1)});
        }
    }
    return triangles;
}

void Placing::add_boundaries(uint32_t content, const glm::dmat4& recentre,
                             std::vector<PrimitiveRecord>& primitives, std::vector<uint32_t>& placed) const {
    const auto add = [&](const std::vector<Corners>& triangles, const glm::dmat4& to_frame, uint32_t leads_to,
                         uint32_t element) {
        for (const Corners& triangle : triangles) {
            PrimitiveRecord p{};
            p.v0 = to_frame * glm::dvec4(triangle[0], 1);
            p.v1 = to_frame * glm::dvec4(triangle[1], 1);
            p.v2 = to_frame * glm::dvec4(triangle[2], 1);
            p.material = scene_.boundary_material;
            p.light = no_record;
            p.attributes = uint32_t(PrimitiveKind::boundary) << 30 | leads_to;
            primitives.push_back(p);
            placed.push_back(uint32_t(scene_.instances.size() + scene_.shapes.size()) + element);
        }
    };
    for (const uint32_t i : held_[content].elements)
        add(held_[scene_.elements[i].content + 1].boundary, recentre * scene_.elements[i].parent_from_local,
            i + 1, i);
    if (content == 0) return;
    const auto first = std::ranges::find(scene_.elements, content - 1, &PlacedElement::content);
    add(held_[content].boundary, recentre, 0, uint32_t(first - scene_.elements.begin()));
}

}  // namespace etendue
