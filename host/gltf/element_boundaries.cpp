// What optical elements are bounded by: closed meshes.
#include <map>
#include <numbers>
#include <tuple>

#include "host/gltf/import.h"

namespace etendue {
namespace {

// Edges of a closed surface that faces one way are each gone along once in either direction.
void check_closed(const JsonAt& at, const GltfImport& import, const std::vector<MeshInstance>& boundary) {
    using Corner = std::tuple<float, float, float>;
    std::map<std::pair<Corner, Corner>, int> edges;
    double volume = 0;
    for (const MeshInstance& instance : boundary) {
        const MeshDescription& mesh = import.scene.meshes[instance.mesh];
        for (const glm::uvec3& t : mesh.triangles) {
            glm::dvec3 p[3];
            Corner corners[3];
            for (int i = 0; i < 3; ++i) {
                const glm::vec3 v = mesh.positions[t[i]] + 0.0f;  // -0 is 0
                p[i] = v, corners[i] = {v.x, v.y, v.z};
            }
            volume += glm::dot(p[0], glm::cross(p[1], p[2]));
            for (int i = 0; i < 3; ++i) {
                const Corner &a = corners[i], &b = corners[(i + 1) % 3];
                a < b ? ++edges[{a, b}] : --edges[{b, a}];
            }
        }
    }
    for (const auto& [edge, balance] : edges)
        if (balance != 0)
            fail_at(at,
                    "is not closed: there is a hole, or a triangle turned round, at ({:g}, {:g}, {:g}); "
                    "allowed: a closed mesh",
                    std::get<0>(edge.first), std::get<1>(edge.first), std::get<2>(edge.first));
    if (!(volume > 0)) fail_at(at, "faces inward; allowed: a closed mesh that faces outward");
}

// Adds a boundary to the meshes.
std::vector<MeshInstance> bounded_by(GltfImport& import, MeshDescription mesh) {
    Bounds bounds;
    for (const glm::vec3& p : mesh.positions)
        bounds.low = glm::min(bounds.low, glm::dvec3(p)), bounds.high = glm::max(bounds.high, glm::dvec3(p));
    import.mesh_bounds.push_back(bounds);
    import.scene.meshes.push_back(std::move(mesh));
    const MeshDescription& added = import.scene.meshes.back();
    return {{uint32_t(import.scene.meshes.size() - 1), import.content_root, added.where}};
}

// Rings of corners about the z axis, {radius, z} from below upward, the first and last of radius 0, so that
// the surface of revolution through them lies within.
MeshDescription turned_mesh(const JsonAt& at, const std::vector<glm::dvec2>& profile) {
    constexpr uint32_t around = 32;
    const double out = 1 / std::cos(std::numbers::pi / around);  // of corners, so that faces are no nearer
    MeshDescription mesh;
    mesh.name = "boundary", mesh.where = at.pointer;
    std::vector<uint32_t> firsts;
    for (const glm::dvec2& p : profile) {
        firsts.push_back(uint32_t(mesh.positions.size()));
        for (uint32_t i = 0; i < (p.x > 0 ? around : 1); ++i) {
            const double turn = 2 * std::numbers::pi * i / around;
            mesh.positions.push_back(glm::dvec3(p.x * out * std::cos(turn), p.x * out * std::sin(turn), p.y));
        }
    }
    for (size_t ring = 0; ring + 1 < profile.size(); ++ring)
        for (uint32_t i = 0; i < around; ++i) {
            const uint32_t j = (i + 1) % around, a = firsts[ring], b = firsts[ring + 1];
            const bool lower = profile[ring].x > 0, upper = profile[ring + 1].x > 0;
            if (lower) mesh.triangles.push_back({a + i, a + j, upper ? b + j : b});
            if (upper) mesh.triangles.push_back({lower ? a + i : a, b + j, b + i});
        }
    return mesh;
}

// A sphere or a cylinder along z, around the origin: no smaller than that.
MeshDescription shape_boundary(const JsonAt& at) {
    const std::string name = text_value(member(at, "class"));
    const double radius = number_value(member(at, "radius"), 1e-9, max_coordinate);
    std::vector<glm::dvec2> profile;
    if (name == "sphere") {
        only_members(at, {"class", "radius"});
        constexpr int rings = 16;
        const double out = radius / std::cos(0.5 * std::numbers::pi / rings);
        for (int i = 0; i <= rings; ++i) {
            const double turn = std::numbers::pi * i / rings;
            profile.push_back({i == 0 || i == rings ? 0 : out * std::sin(turn), -out * std::cos(turn)});
        }
    } else if (name == "cylinder") {
        only_members(at, {"class", "radius", "height"});
        const double half = 0.5 * number_value(member(at, "height"), 1e-9, max_coordinate);
        profile = {{0, -half}, {radius, -half}, {radius, half}, {0, half}};
    } else {
        fail_at(member(at, "class"), "is '{}'; allowed: sphere, cylinder", name);
    }
    return turned_mesh(at, profile);
}

}  // namespace

std::vector<MeshInstance> read_boundary(GltfImport& import, const JsonAt& element) {
    const std::optional<JsonAt> at = find(element, "boundary");
    if (!at) return {};
    if ((*at)->is_string()) {
        if (text_value(*at) != "box")
            fail_at(*at, "is '{}'; allowed: \"box\", the index of a mesh, or a sphere or cylinder",
                    text_value(*at));
        return {};
    }
    if ((*at)->is_object()) return bounded_by(import, shape_boundary(*at));
    const uint32_t mesh = index_value(*at, array_size(import.root, "meshes"), "/meshes");
    const MeshRange range = read_mesh(import, mesh, {});
    std::vector<MeshInstance> boundary;
    for (uint32_t i = range.first; i < range.first + range.count; ++i)
        boundary.push_back({i, import.content_root, element.pointer, import.scene.meshes[i].name, 0});
    if (boundary.empty()) fail_at(*at, "has no triangles; allowed: a closed mesh");
    check_closed(*at, import, boundary);
    return boundary;
}

void bound_by_box(GltfImport& import, const JsonAt& at, const std::vector<double>& size, double low,
                  double high) {
    const glm::vec3 half(0.5 * size[0], 0.5 * size[1], 0);
    const float lo = float(low), hi = float(high);
    MeshDescription box;
    box.name = "boundary", box.where = at.pointer;
    for (int i = 0; i < 8; ++i)
        box.positions.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? hi : lo});
    box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    import.scene.contents.back().boundary = bounded_by(import, std::move(box));
}

}  // namespace etendue
