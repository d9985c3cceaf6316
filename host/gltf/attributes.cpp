// Attributes of vertices: those of a primitive, of its morph targets and of skins.
#include <algorithm>
#include <cmath>

#include "host/gltf/import.h"

namespace etendue {
namespace {

bool is_among(const Accessor& a, std::initializer_list<Component> floats_and_integers,
              bool integers_normalized) {
    if (a.component == Component::f32) return true;
    for (Component c : floats_and_integers)
        if (c == a.component) return !integers_normalized || a.normalized;
    return false;
}

template <class Vector>
bool all_finite(const std::vector<Vector>& values, float limit) {
    const float* v = reinterpret_cast<const float*>(values.data());
    size_t count = values.size() * Vector::length();
    uint32_t bad = 0;  // counted without a branch: this runs over every vertex of large scenes
    for (size_t i = 0; i < count; ++i) bad += !(std::fabs(v[i]) <= limit);
    return bad == 0;
}

// An attribute of the primitive; empty where the primitive does not have it.
template <class Vector>
std::vector<Vector> read_attribute(GltfImport& import, const JsonAt& attributes, const char* name,
                                   VertexRange range, size_t vertex_count,
                                   std::initializer_list<const char*> types,
                                   std::initializer_list<Component> integers, bool integers_normalized) {
    std::vector<Vector> values;
    std::optional<JsonAt> at = find(attributes, name);
    if (!at) return values;
    const Accessor& accessor = accessor_at(import, *at);
    bool type_known =
        std::any_of(types.begin(), types.end(), [&](const char* t) { return accessor.type == t; });
    if (!type_known)
        fail_at(*at, "is an accessor of type {}; must be {}", accessor.type, fmt::join(types, " or "));
    if (!is_among(accessor, integers, integers_normalized))
        fail_at(*at, "is an accessor with components {}{}; not a form that {} may have",
                uint32_t(accessor.component), accessor.normalized ? ", normalised" : "", name);
    if (accessor.count != vertex_count)
        fail_at(*at, "has {} elements; POSITION has {}", accessor.count, vertex_count);
    values.resize(range.count, Vector(1.0f));
    read_floats(accessor, range.first, range.count, &values[0].x, Vector::length());
    if (!all_finite(values, float(max_coordinate)))
        fail_at(*at, "has a value that is not finite, or beyond {:g}", max_coordinate);
    return values;
}

// The integer forms beside those of glTF 2.0 are KHR_mesh_quantization's.
const std::initializer_list<Component> integers = {Component::i8, Component::u8, Component::i16,
                                                   Component::u16},
                                       signed_integers = {Component::i8, Component::i16},
                                       unsigned_integers = {Component::u8, Component::u16};

}  // namespace

bool are_within_limits(const std::vector<glm::vec3>& positions) {
    return all_finite(positions, float(max_coordinate));
}

void read_attributes(GltfImport& import, const JsonAt& attributes, size_t vertex_count, VertexRange range,
                     MeshDescription& mesh) {
    mesh.positions = read_attribute<glm::vec3>(import, attributes, "POSITION", range, vertex_count, {"VEC3"},
                                               integers, false);
    mesh.normals = read_attribute<glm::vec3>(import, attributes, "NORMAL", range, vertex_count, {"VEC3"},
                                             signed_integers, true);
    mesh.tangents = read_attribute<glm::vec4>(import, attributes, "TANGENT", range, vertex_count, {"VEC4"},
                                              signed_integers, true);
    mesh.uv0 = read_attribute<glm::vec2>(import, attributes, "TEXCOORD_0", range, vertex_count, {"VEC2"},
                                         integers, false);
    mesh.uv1 = read_attribute<glm::vec2>(import, attributes, "TEXCOORD_1", range, vertex_count, {"VEC2"},
                                         integers, false);
    mesh.colors = read_attribute<glm::vec4>(import, attributes, "COLOR_0", range, vertex_count,
                                            {"VEC3", "VEC4"}, unsigned_integers, true);
}

MeshDescription read_morph_target(GltfImport& import, const JsonAt& target, size_t vertex_count,
                                  VertexRange range) {
    require_object(target);
    MeshDescription change;
    const auto read = [&]<class Vector>(std::vector<Vector>& values, const char* name,
                                        std::initializer_list<const char*> types,
                                        std::initializer_list<Component> forms, bool normalized) {
        values = read_attribute<Vector>(import, target, name, range, vertex_count, types, forms, normalized);
    };
    read(change.positions, "POSITION", {"VEC3"}, integers, false);
    read(change.normals, "NORMAL", {"VEC3"}, signed_integers, true);
    read(change.uv0, "TEXCOORD_0", {"VEC2"}, integers, false);
    read(change.uv1, "TEXCOORD_1", {"VEC2"}, integers, false);
    read(change.colors, "COLOR_0", {"VEC3", "VEC4"}, integers, true);
    if (std::optional<JsonAt> color = find(target, "COLOR_0");
        color && accessor_at(import, *color).type == "VEC3")
        for (glm::vec4& c : change.colors) c.w = 0;
    std::vector<glm::vec3> tangents;
    read(tangents, "TANGENT", {"VEC3"}, signed_integers, true);
    for (const glm::vec3& t : tangents) change.tangents.emplace_back(t, 0.0f);
    return change;
}

std::vector<glm::vec4> read_joints(GltfImport& import, const JsonAt& attributes, const std::string& name,
                                   VertexRange range, size_t vertex_count) {
    JsonAt at = member(attributes, name);
    const Accessor& accessor = accessor_at(import, at);
    if (accessor.component == Component::f32 || accessor.normalized)
        fail_at(at, "must be an accessor of type VEC4 with whole numbers (5121 or 5123)");
    return read_attribute<glm::vec4>(import, attributes, name.c_str(), range, vertex_count, {"VEC4"},
                                     unsigned_integers, false);
}

std::vector<glm::vec4> read_joint_weights(GltfImport& import, const JsonAt& attributes,
                                          const std::string& name, VertexRange range, size_t vertex_count) {
    member(attributes, name);  // must be there
    return read_attribute<glm::vec4>(import, attributes, name.c_str(), range, vertex_count, {"VEC4"},
                                     unsigned_integers, true);
}

}  // namespace etendue
