// What shapes the meshes of nodes anew: morph targets by their weights (glTF 2.0, section 3.7.2.2), then
// skins by their joints (section 3.7.3).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "host/gltf/import.h"

namespace etendue {
namespace {

constexpr int most_joint_sets = 8;  // JOINTS_0 to JOINTS_7

std::vector<double> weights_value(const JsonAt& at) {
    require_array(at);
    return number_array(at, at->size(), -max_coordinate, max_coordinate);
}

// Where every node stands, from wherever its tree begins: joints may be outside of the scene that is shown.
std::vector<glm::dmat4> world_transforms(const GltfImport& import) {
    std::vector<glm::dmat4> worlds(import.parents.size());
    std::vector<bool> known(worlds.size(), false);
    std::vector<uint32_t> path;
    for (uint32_t node = 0; node < worlds.size(); ++node) {
        for (uint32_t n = node; n != UINT32_MAX && !known[n]; n = import.parents[n]) path.push_back(n);
        for (; !path.empty(); path.pop_back()) {
            const uint32_t n = path.back(), parent = import.parents[n];
            worlds[n] = local_transform(import, n);
            if (parent != UINT32_MAX) worlds[n] = worlds[parent] * worlds[n];
            known[n] = true;
        }
    }
    return worlds;
}

std::vector<glm::dmat4> inverse_bind_matrices(GltfImport& import, const JsonAt& skin, size_t joints) {
    std::vector<glm::dmat4> result(joints, glm::dmat4(1.0));
    std::optional<JsonAt> at = find(skin, "inverseBindMatrices");
    if (!at) return result;
    const Accessor& accessor = accessor_at(import, *at);
    if (accessor.type != "MAT4" || accessor.component != Component::f32)
        fail_at(*at, "must be an accessor of type MAT4 with floats (5126)");
    if (accessor.count < joints)
        fail_at(*at, "has {} elements; the skin has {} joints", accessor.count, joints);
    std::vector<float> values(16 * joints);
    read_floats(accessor, 0, joints, values.data(), 16);
    for (size_t i = 0; i < values.size(); ++i) {
        if (!(std::fabs(values[i]) <= max_coordinate))
            fail_at(*at, "has a value that is not finite, or beyond {:g}", max_coordinate);
        result[i / 16][int(i % 16 / 4)][int(i % 4)] = values[i];
    }
    for (glm::dmat4& m : result)
        for (int c = 0; c < 4; ++c) m[c][3] = c == 3;  // affine, but for rounding
    return result;
}

template <class Vector>
void add_scaled(std::vector<Vector>& values, const std::vector<Vector>& change, double weight) {
    if (values.size() != change.size()) return;  // the mesh itself has none of this attribute
    for (size_t i = 0; i < values.size(); ++i) values[i] += Vector(change[i] * float(weight));
}

// The matrix of each vertex: that of its joints by their weights.
std::vector<glm::dmat4> vertex_matrices(GltfImport& import, const JsonAt& attributes, VertexRange range,
                                        size_t vertex_count, const std::vector<glm::dmat4>& joints) {
    std::vector<glm::dmat4> result(range.count, glm::dmat4(0.0));
    std::vector<double> sums(range.count, 0.0);
    for (int set = 0; set < most_joint_sets; ++set) {
        const std::string joints_name = fmt::format("JOINTS_{}", set),
                          weights_name = fmt::format("WEIGHTS_{}", set);
        if (!find(attributes, joints_name) && !find(attributes, weights_name)) break;
        const auto of = read_joints(import, attributes, joints_name, range, vertex_count);
        const auto by = read_joint_weights(import, attributes, weights_name, range, vertex_count);
        for (size_t v = 0; v < range.count; ++v)
            for (int k = 0; k < 4; ++k) {
                const double weight = by[v][k];
                if (weight == 0) continue;
                if (weight < 0)
                    fail_at(member(attributes, weights_name),
                            "has the weight {} at vertex {}; must be at least 0", weight, range.first + v);
                if (of[v][k] >= float(joints.size()))
                    fail_at(member(attributes, joints_name), "has joint {} at vertex {}; the skin has {}",
                            of[v][k], range.first + v, joints.size());
                result[v] += weight * joints[size_t(of[v][k])];
                sums[v] += weight;
            }
    }
    // Weights are to sum up to 1; a vertex without any goes with the first joint.
    for (size_t v = 0; v < range.count; ++v) result[v] = sums[v] > 0 ? result[v] / sums[v] : joints[0];
    return result;
}

}  // namespace

size_t morph_targets(const GltfImport& import, const JsonAt& node) {
    std::optional<uint32_t> mesh = index(node, "mesh", array_size(import.root, "meshes"), "/meshes");
    if (!mesh) return 0;
    JsonAt primitives = member(document_element(import, "meshes", *mesh), "primitives");
    require_array(primitives);
    return primitives->empty() ? 0 : array_size(element(primitives, 0), "targets");
}

Deformation deformation_of(GltfImport& import, uint32_t n) {
    JsonAt node = document_element(import, "nodes", n);
    JsonAt mesh = document_element(import, "meshes", size_t((*node)["mesh"].get<double>()));
    Deformation result;
    std::optional<JsonAt> weights = find(node, "weights");
    if (!weights) weights = find(mesh, "weights");
    if (weights) result.weights = weights_value(*weights), result.weights_at = *weights;
    if (import.poses[n].weights) result.weights = *import.poses[n].weights, result.weights_at = node;
    if (std::all_of(result.weights.begin(), result.weights.end(), [](double w) { return w == 0; }))
        result.weights.clear();
    std::optional<uint32_t> skin = index(node, "skin", array_size(import.root, "skins"), "/skins");
    if (!skin) return result;
    JsonAt skin_at = document_element(import, "skins", *skin);
    JsonAt joints = member(skin_at, "joints");
    require_array(joints);
    if (joints->empty()) fail_at(joints, "is empty; a skin has at least one joint");
    if (import.worlds.empty()) import.worlds = world_transforms(import);
    result.joints = inverse_bind_matrices(import, skin_at, joints->size());
    for (size_t j = 0; j < joints->size(); ++j) {
        const uint32_t joint = index_value(element(joints, j), import.parents.size(), "/nodes");
        result.joints[j] = import.worlds[joint] * result.joints[j];
    }
    return result;
}

void morph(GltfImport& import, const JsonAt& primitive, size_t vertex_count, VertexRange range,
           const Deformation& deformation, MeshDescription& mesh) {
    const std::vector<double>& weights = deformation.weights;
    const size_t targets = array_size(primitive, "targets");
    if (weights.empty() || targets == 0) return;
    if (weights.size() != targets)
        fail_at(deformation.weights_at, "has {} weights; {} has {} morph targets", weights.size(),
                primitive.pointer, targets);
    for (size_t t = 0; t < targets; ++t) {
        if (weights[t] == 0) continue;
        const MeshDescription change =
            read_morph_target(import, element(member(primitive, "targets"), t), vertex_count, range);
        add_scaled(mesh.positions, change.positions, weights[t]);
        add_scaled(mesh.normals, change.normals, weights[t]);
        add_scaled(mesh.tangents, change.tangents, weights[t]);  // w of a change is 0
        add_scaled(mesh.uv0, change.uv0, weights[t]);
        add_scaled(mesh.uv1, change.uv1, weights[t]);
        add_scaled(mesh.colors, change.colors, weights[t]);
    }
    for (glm::vec4& color : mesh.colors) color = glm::clamp(color, 0.0f, 1.0f);
}

void skin(GltfImport& import, const JsonAt& attributes, size_t vertex_count, VertexRange range,
          const Deformation& deformation, MeshDescription& mesh) {
    if (deformation.joints.empty()) return;
    const auto matrices = vertex_matrices(import, attributes, range, vertex_count, deformation.joints);
    for (size_t v = 0; v < matrices.size(); ++v) {
        const glm::dmat4& m = matrices[v];
        const glm::dmat3 linear(m);
        mesh.positions[v] = glm::vec3(m * glm::dvec4(mesh.positions[v], 1));
        // Cofactors: as the inverse transposed but for a factor, and finite where space is squashed.
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const double side = glm::determinant(linear) < 0 ? -1 : 1;
        if (!mesh.normals.empty()) {
            const glm::dvec3 n = side * (cofactors * glm::dvec3(mesh.normals[v]));
            mesh.normals[v] = glm::length(n) > 0 ? glm::vec3(glm::normalize(n)) : glm::vec3(0);
        }
        if (!mesh.tangents.empty()) {
            const glm::dvec3 t = linear * glm::dvec3(mesh.tangents[v]);
            const glm::vec3 unit = glm::length(t) > 0 ? glm::vec3(glm::normalize(t)) : glm::vec3(0);
            mesh.tangents[v] = glm::vec4(unit, mesh.tangents[v].w);
        }
    }
}

}  // namespace etendue
