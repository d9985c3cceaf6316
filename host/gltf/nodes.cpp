// The node hierarchy: checked to be a forest, then walked from the roots, with transforms in double
// precision.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "host/gltf/import.h"

namespace etendue {
namespace {

glm::dmat4 trs_matrix(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale) {
    glm::dmat4 m = glm::mat4_cast(rotation);
    for (int c = 0; c < 3; ++c) m[c] *= scale[c];
    m[3] = glm::dvec4(translation, 1);
    return m;
}

// Any length but 0: exporters write quaternions with few digits.
glm::dquat unit_quaternion(const JsonAt& at, double x, double y, double z, double w) {
    glm::dquat q(w, x, y, z);
    double length = glm::length(q);
    if (!(length > 1e-6)) fail_at(at, "is a quaternion of zero length; must have length 1");
    return q / length;
}

}  // namespace

glm::dmat4 local_transform(const GltfImport& import, uint32_t n) {
    JsonAt node = document_element(import, "nodes", n);
    const NodePose& pose = import.poses[n];
    const bool is_posed = pose.translation || pose.rotation || pose.scale;
    const double limit = max_coordinate;
    // glTF has no node with a matrix animated; where one is, the animation says all.
    if (std::optional<JsonAt> at = find(node, "matrix"); at && !is_posed) {
        std::vector<double> v = number_array(*at, 16, -limit, limit);
        if (v[3] != 0 || v[7] != 0 || v[11] != 0 || v[15] != 1)
            fail_at(*at, "is not affine; elements 3, 7, 11 and 15 must be 0, 0, 0 and 1");
        glm::dmat4 m;
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = v[i];
        return m;
    }
    std::vector<double> t = numbers(node, "translation", {0, 0, 0}, -limit, limit);
    std::vector<double> r = numbers(node, "rotation", {0, 0, 0, 1}, -limit, limit);
    std::vector<double> s = numbers(node, "scale", {1, 1, 1}, -limit, limit);
    glm::dquat q(1, 0, 0, 0);
    if (std::optional<JsonAt> at = find(node, "rotation")) q = unit_quaternion(*at, r[0], r[1], r[2], r[3]);
    return trs_matrix(pose.translation.value_or(glm::dvec3(t[0], t[1], t[2])), pose.rotation.value_or(q),
                      pose.scale.value_or(glm::dvec3(s[0], s[1], s[2])));
}

namespace {

// Fails where a node has two parents or is its own ancestor. Returns each node's parent, UINT32_MAX for
// roots.
std::vector<uint32_t> check_hierarchy(const GltfImport& import) {
    size_t count = array_size(import.root, "nodes");
    std::vector<uint32_t> parent(count, UINT32_MAX);
    for (uint32_t n = 0; n < count; ++n) {
        std::optional<JsonAt> children = find_array(document_element(import, "nodes", n), "children");
        for (size_t c = 0; children && c < (*children)->size(); ++c) {
            JsonAt at = element(*children, c);
            uint32_t child = index_value(at, count, "/nodes");
            if (parent[child] != UINT32_MAX)
                fail_at(at, "node {} is already a child of node {}; a node has one parent at most", child,
                        parent[child]);
            parent[child] = n;
        }
    }
    std::vector<uint8_t> done(count, 0);  // 1 = on the path now followed, 2 = leads to a root
    for (uint32_t n = 0; n < count; ++n) {
        uint32_t i = n;
        for (; i != UINT32_MAX && done[i] == 0; i = parent[i]) done[i] = 1;
        if (i != UINT32_MAX && done[i] == 1)
            fail_at(document_element(import, "nodes", i), "is its own ancestor; nodes must form trees");
        for (i = n; i != UINT32_MAX && done[i] == 1; i = parent[i]) done[i] = 2;
    }
    return parent;
}

// The nodes that a scene of the file lists; without scenes, every root.
std::vector<uint32_t> root_nodes(GltfImport& import, uint32_t chosen) {
    const std::vector<uint32_t>& parent = import.parents;
    std::vector<uint32_t> roots;
    if (array_size(import.root, "scenes") == 0) {
        for (uint32_t n = 0; n < parent.size(); ++n)
            if (parent[n] == UINT32_MAX) roots.push_back(n);
        return roots;
    }
    JsonAt scene = document_element(import, "scenes", chosen);
    std::vector<bool> listed(parent.size(), false);
    for (size_t i = 0; i < array_size(scene, "nodes"); ++i) {
        JsonAt at = element(member(scene, "nodes"), i);
        uint32_t n = index_value(at, parent.size(), "/nodes");
        if (parent[n] != UINT32_MAX)
            fail_at(at, "node {} is a child of node {}; a scene lists root nodes only", n, parent[n]);
        if (listed[n]) fail_at(at, "node {} is listed twice; a scene lists each root node once", n);
        listed[n] = true;
        roots.push_back(n);
    }
    return roots;
}

// The transforms of EXT_mesh_gpu_instancing; one identity where the node does not have it.
std::vector<glm::dmat4> gpu_instances(GltfImport& import, const JsonAt& node) {
    std::optional<JsonAt> extension = find_extension(node, "EXT_mesh_gpu_instancing");
    if (!extension) return {glm::dmat4(1.0)};
    JsonAt attributes = member(*extension, "attributes");
    size_t count = SIZE_MAX;
    auto read = [&](const char* name, const char* type, bool integers) {
        std::vector<float> values;
        std::optional<JsonAt> at = find(attributes, name);
        if (!at) return values;
        const Accessor& a = accessor_at(import, *at);
        bool known =
            a.component == Component::f32 ||
            (integers && a.normalized && (a.component == Component::i8 || a.component == Component::i16));
        if (a.type != type || !known) fail_at(*at, "is not an accessor of the form that {} must have", name);
        if (count != SIZE_MAX && a.count != count)
            fail_at(*at, "has {} elements; the other attributes have {}", a.count, count);
        count = a.count;
        if (count > max_objects) fail_at(*at, "has {} elements; at most {} are allowed", count, max_objects);
        values.resize(count * a.components);
        read_floats(a, 0, count, values.data(), a.components);
        for (float v : values)
            if (!(std::fabs(v) <= max_coordinate))
                fail_at(*at, "has a value that is not finite, or beyond {:g}", max_coordinate);
        return values;
    };
    std::vector<float> t = read("TRANSLATION", "VEC3", false), r = read("ROTATION", "VEC4", true),
                       s = read("SCALE", "VEC3", false);
    if (count == SIZE_MAX) return {glm::dmat4(1.0)};
    std::vector<glm::dmat4> result(count);
    for (size_t i = 0; i < count; ++i) {
        glm::dvec3 translation(0), scale(1);
        glm::dquat rotation(1, 0, 0, 0);
        if (!t.empty()) translation = {t[3 * i], t[3 * i + 1], t[3 * i + 2]};
        if (!r.empty())
            rotation = unit_quaternion(member(attributes, "ROTATION"), r[4 * i], r[4 * i + 1], r[4 * i + 2],
                                       r[4 * i + 3]);
        if (!s.empty()) scale = {s[3 * i], s[3 * i + 1], s[3 * i + 2]};
        result[i] = trs_matrix(translation, rotation, scale);
    }
    return result;
}

// In world space, too, coordinates must be such that 32-bit floats can hold their squares.
void check_world_bounds(const JsonAt& node, const Bounds& bounds, const glm::dmat4& m) {
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 p(corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                     corner & 4 ? bounds.high.z : bounds.low.z);
        glm::dvec3 w = glm::dvec3(m * glm::dvec4(p, 1));
        for (int a = 0; a < 3; ++a)
            if (!(std::fabs(w[a]) <= max_coordinate))
                fail_at(node, "its mesh reaches coordinates beyond {:g} in world space", max_coordinate);
    }
}

// A skinned mesh stands where its joints are, whatever the node's own place (glTF 2.0, section 3.7.3.3).
std::vector<glm::dmat4> placements(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local,
                                   const Deformation& deformation) {
    if (!deformation.joints.empty()) return {import.content_root};
    std::vector<glm::dmat4> result = gpu_instances(import, node);
    for (glm::dmat4& m : result) m = world_from_local * m;
    return result;
}

void place_mesh(GltfImport& import, uint32_t n, const glm::dmat4& world_from_local) {
    JsonAt node = document_element(import, "nodes", n);
    std::optional<uint32_t> mesh = index(node, "mesh", array_size(import.root, "meshes"), "/meshes");
    if (!mesh) return;
    const Deformation deformation = deformation_of(import, n);
    const MeshRange range = read_mesh(import, *mesh, deformation);
    const std::vector<glm::dmat4> places = placements(import, node, world_from_local, deformation);
    if (places.size() * range.count + import.scene.instances.size() > max_objects)
        fail_at(node, "the scene has more than {} instances of meshes", max_objects);
    bool flat = false;
    for (const glm::dmat4& place : places) {
        MeshInstance instance{0, place, node.pointer};
        if (!is_invertible(instance.world_from_local)) {
            flat = true;
            continue;
        }
        for (uint32_t i = range.first; i < range.first + range.count; ++i) {
            check_world_bounds(node, import.mesh_bounds[i], instance.world_from_local);
            instance.mesh = i;
            instance.name = text(node, "name", import.scene.meshes[i].name);
            import.scene.instances.push_back(instance);
        }
    }
    if (flat) warn(import, node, "has a transform that squashes space flat: the mesh is left out there");
}

}  // namespace

bool is_invertible(const glm::dmat4& matrix) {
    glm::dvec3 x(matrix[0]), y(matrix[1]), z(matrix[2]);
    double product = glm::length(x) * glm::length(y) * glm::length(z);
    return product > 0 && std::fabs(glm::dot(x, glm::cross(y, z))) > 1e-10 * product;
}

// The nodes of one scene of the file, which are placed below the import's content_root.
void place_nodes(GltfImport& import, uint32_t scene) {
    struct Visit {
        uint32_t node;
        glm::dmat4 world_from_parent;
    };
    const std::vector<uint32_t> roots = root_nodes(import, scene);
    std::vector<Visit> open;
    for (size_t i = roots.size(); i-- > 0;) open.push_back({roots[i], import.content_root});
    while (!open.empty()) {
        Visit visit = open.back();
        open.pop_back();
        JsonAt node = document_element(import, "nodes", visit.node);
        glm::dmat4 world = visit.world_from_parent * local_transform(import, visit.node);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r)
                if (!(std::fabs(world[c][r]) <= max_coordinate))
                    fail_at(node, "its transform in world space has an element beyond {:g}", max_coordinate);
        place_mesh(import, visit.node, world);
        read_node_camera(import, node, world);
        read_node_light(import, node, world);
        read_node_profile(import, node, world);
        read_node_optics(import, node, world);
        std::optional<JsonAt> children = find(node, "children");
        for (size_t c = children ? (*children)->size() : 0; c-- > 0;)
            open.push_back({uint32_t((**children)[c].get<double>()), world});
    }
}

void load_nodes(GltfImport& import) {
    import.mesh_ranges.resize(array_size(import.root, "meshes"));
    import.parents = check_hierarchy(import);
    pose_nodes(import);
    const size_t scenes = array_size(import.root, "scenes");
    const uint32_t scene = index(import.root, "scene", scenes, "/scenes").value_or(0);
    place_nodes(import, scene);
    load_elements(import, scene);
    if (const auto& none = import.zero_area; none.meshes > 0)
        warn(import, {nullptr, none.first_pointer, &import.file_name},
             fmt::format("mesh '{}' has triangles of zero area: {} in {} mesh{} are left out",
                         none.first_name, none.triangles, none.meshes, none.meshes == 1 ? "" : "es"));
}

}  // namespace etendue
