// Meshes: each primitive of triangles becomes a MeshDescription with only the vertices that it uses.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "host/gltf/import.h"

namespace etendue {
namespace {

enum Mode : uint64_t { points = 0, triangles = 4, strip = 5, fan = 6 };

// The corners of the triangles as indices of vertices, as glTF 2.0, section 3.7.2.1 orders them.
std::vector<glm::uvec3> triangles_of(const JsonAt& primitive, uint64_t mode, std::vector<uint32_t> corners) {
    std::vector<glm::uvec3> result;
    if (mode == triangles) {
        if (corners.size() % 3 != 0)
            fail_at(primitive, "has {} corners of triangles; must be a multiple of 3", corners.size());
        result.resize(corners.size() / 3);
        for (size_t i = 0; i < result.size(); ++i)
            result[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
        return result;
    }
    if (corners.size() < 3)
        fail_at(primitive, "has {} corners; a strip or fan has at least 3", corners.size());
    result.resize(corners.size() - 2);
    for (size_t i = 0; i < result.size(); ++i)
        result[i] = mode == fan ? glm::uvec3(corners[i + 1], corners[i + 2], corners[0])
                                : glm::uvec3(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
    return result;
}

std::vector<uint32_t> corners_of(GltfImport& import, const JsonAt& primitive, size_t vertex_count) {
    std::optional<JsonAt> at = find(primitive, "indices");
    std::vector<uint32_t> corners;
    if (!at) {
        corners.resize(vertex_count);
        for (size_t i = 0; i < vertex_count; ++i) corners[i] = uint32_t(i);
        return corners;
    }
    const Accessor& accessor = accessor_at(import, *at);
    if (accessor.type != "SCALAR" || accessor.normalized ||
        !(accessor.component == Component::u8 || accessor.component == Component::u16 ||
          accessor.component == Component::u32))
        fail_at(*at, "must be an accessor of type SCALAR with unsigned integers (5121, 5123 or 5125)");
    corners = read_indices(accessor);
    uint32_t highest = 0;
    for (uint32_t corner : corners) highest = std::max(highest, corner);
    if (highest >= vertex_count) {
        auto bad =
            std::find_if(corners.begin(), corners.end(), [&](uint32_t c) { return c >= vertex_count; });
        fail_at(*at, "has index {} at position {}; the primitive has {} vertices", *bad,
                bad - corners.begin(), vertex_count);
    }
    return corners;
}

template <class Vector>
void gather(std::vector<Vector>& values, const std::vector<uint32_t>& vertices) {
    if (values.empty()) return;
    std::vector<Vector> kept(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) kept[i] = values[vertices[i]];
    values = std::move(kept);
}

// Primitives often share one large set of vertices: where this one uses few of its range, only those are
// kept.
void drop_unused_vertices(MeshDescription& mesh) {
    if (mesh.triangles.size() * 3 >= mesh.positions.size() / 2) return;
    std::vector<uint32_t> place(mesh.positions.size(), UINT32_MAX), vertices;
    for (glm::uvec3& triangle : mesh.triangles)
        for (int c = 0; c < 3; ++c) {
            uint32_t& to = place[triangle[c]];
            if (to == UINT32_MAX) to = uint32_t(vertices.size()), vertices.push_back(triangle[c]);
            triangle[c] = to;
        }
    gather(mesh.positions, vertices);
    gather(mesh.normals, vertices);
    gather(mesh.tangents, vertices);
    gather(mesh.uv0, vertices);
    gather(mesh.uv1, vertices);
    gather(mesh.colors, vertices);
}

// Differences and products of floats lose little or nothing in double: only a true zero is dropped.
glm::dvec3 area_vector(const MeshDescription& mesh, const glm::uvec3& t) {
    glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    return glm::cross(b - a, c - a);
}

size_t drop_zero_area(MeshDescription& mesh) {
    size_t before = mesh.triangles.size();
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
        if (t.x == t.y || t.y == t.z || t.z == t.x) return true;
        glm::dvec3 n = area_vector(mesh, t);
        return n.x == 0 && n.y == 0 && n.z == 0;
    });
    return before - mesh.triangles.size();
}

// Unit normals; one of zero length becomes that of a triangle at the vertex.
void normalize_normals(MeshDescription& mesh) {
    bool lost = false;
    for (glm::vec3& n : mesh.normals) {
        double length = glm::length(glm::dvec3(n));
        if (length > 0) n = glm::vec3(glm::dvec3(n) / length);
        lost = lost || !(length > 0);
    }
    if (!lost) return;
    for (const glm::uvec3& t : mesh.triangles)
        for (int c = 0; c < 3; ++c) {
            glm::vec3& n = mesh.normals[t[c]];
            if (n == glm::vec3(0)) n = glm::vec3(glm::normalize(area_vector(mesh, t)));
        }
    for (glm::vec3& n : mesh.normals)
        if (n == glm::vec3(0)) n = glm::vec3(0, 0, 1);  // of no triangle
}

// Unit tangents; one of zero length becomes any direction in the surface.
void normalize_tangents(MeshDescription& mesh) {
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        glm::dvec3 t = glm::dvec3(mesh.tangents[i]);
        double length = glm::length(t);
        if (length > 0) {
            t /= length;
        } else {
            glm::dvec3 n = mesh.normals.empty() ? glm::dvec3(0, 0, 1) : glm::dvec3(mesh.normals[i]);
            t = glm::normalize(
                glm::cross(n, std::fabs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        }
        mesh.tangents[i] = glm::vec4(glm::vec3(t), mesh.tangents[i].w < 0 ? -1.0f : 1.0f);
    }
}

// The material of the primitive, for the variant that is wanted (KHR_materials_variants).
std::optional<uint32_t> material_of(const GltfImport& import, const JsonAt& primitive) {
    const size_t count = array_size(import.root, "materials");
    if (std::optional<JsonAt> variants = find_extension(primitive, "KHR_materials_variants"))
        for (size_t m = 0; m < array_size(*variants, "mappings"); ++m) {
            JsonAt mapping = element(member(*variants, "mappings"), m);
            const uint32_t material = index_value(member(mapping, "material"), count, "/materials");
            JsonAt of = member(mapping, "variants");
            require_array(of);
            for (size_t v = 0; v < of->size(); ++v)
                if (index_value(element(of, v), import.scene.variants.size(), "the file's variants") ==
                    import.variant)
                    return material;
        }
    return index(primitive, "material", count, "/materials");
}

// False where the primitive has no triangles.
bool read_primitive(GltfImport& import, const JsonAt& primitive, const Deformation& deformation,
                    MeshDescription& mesh) {
    uint64_t mode = integer(primitive, "mode", triangles, 0, 6);
    JsonAt attributes = member(primitive, "attributes");
    require_object(attributes);
    const std::optional<uint32_t> material = material_of(import, primitive);
    if (mode < triangles) {
        const char* what = mode == points ? "points" : "lines";
        warn_once(import, what, primitive,
                  fmt::format("{} are not modelled: left out of mesh '{}'", what, mesh.name));
        return false;
    }
    decode_draco(import, primitive);
    std::optional<JsonAt> position = find(attributes, "POSITION");
    if (!position) {
        warn(import, attributes, fmt::format("mesh '{}' has no POSITION: left out", mesh.name));
        return false;
    }
    size_t vertex_count = accessor_at(import, *position).count;
    mesh.triangles = triangles_of(primitive, mode, corners_of(import, primitive, vertex_count));

    uint32_t low = UINT32_MAX, high = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        low = std::min({low, t.x, t.y, t.z});
        high = std::max({high, t.x, t.y, t.z});
    }
    const VertexRange range = {low, size_t(high) - low + 1};
    read_attributes(import, attributes, vertex_count, range, mesh);
    if (!deformation.none()) {
        import.deformed_vertices += range.count;
        if (import.deformed_vertices > max_deformed_vertices)
            fail_at(primitive, "the nodes of the scene have more than {} vertices by targets and skins",
                    max_deformed_vertices);
        morph(import, primitive, vertex_count, range, deformation, mesh);
        skin(import, attributes, vertex_count, range, deformation, mesh);
        if (!are_within_limits(mesh.positions))
            fail_at(primitive, "is carried to coordinates beyond {:g} by its targets or joints",
                    max_coordinate);
    }
    if (low > 0)
        for (glm::uvec3& t : mesh.triangles) t -= low;

    if (size_t dropped = drop_zero_area(mesh)) {
        if (import.zero_area.meshes++ == 0)
            import.zero_area.first_pointer = primitive.pointer, import.zero_area.first_name = mesh.name;
        import.zero_area.triangles += dropped;
    }
    if (mesh.triangles.empty()) return false;
    drop_unused_vertices(mesh);
    normalize_normals(mesh);
    normalize_tangents(mesh);
    mesh.material = material ? *material : default_material(import);
    if (material && !mesh.colors.empty() &&
        find_extension(document_element(import, "materials", *material), "KHR_materials_unlit"))
        warn_once(import, "unlit colors", primitive, "colours of vertices do not count on unlit materials");
    return true;
}

Bounds bounds_of(const MeshDescription& mesh) {
    glm::vec3 low(FLT_MAX), high(-FLT_MAX);
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    return {low, high};
}

}  // namespace

MeshRange read_mesh(GltfImport& import, uint32_t gltf_mesh, const Deformation& deformation) {
    MeshRange deformed;  // one for the node alone
    MeshRange& range = deformation.none() ? import.mesh_ranges[gltf_mesh] : deformed;
    if (range.read) return range;
    range = {uint32_t(import.scene.meshes.size()), 0, true};
    JsonAt at = document_element(import, "meshes", gltf_mesh);
    JsonAt primitives = member(at, "primitives");
    require_array(primitives);
    for (size_t i = 0; i < primitives->size(); ++i) {
        JsonAt primitive = element(primitives, i);
        MeshDescription mesh;
        mesh.name = text(at, "name", fmt::format("mesh {}", gltf_mesh));
        mesh.where = primitive.pointer;
        if (!read_primitive(import, primitive, deformation, mesh)) continue;
        import.mesh_bounds.push_back(bounds_of(mesh));
        import.scene.meshes.push_back(std::move(mesh));
        ++range.count;
    }
    return range;
}

}  // namespace etendue
