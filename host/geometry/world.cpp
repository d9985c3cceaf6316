#include "host/geometry/world.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "host/error.h"
#include "host/geometry/placing.h"
#include "host/geometry/twins.h"
#include "host/scene/records.h"
#include "host/scene/watched_surface.h"

namespace etendue {
namespace {

constexpr uint64_t small_mesh_triangles =
    65536;  // all copies of a mesh together: merged rather than instanced

bool has_attributes(const MeshDescription& mesh) {
    return !mesh.normals.empty() || !mesh.tangents.empty() || !mesh.uv0.empty() || !mesh.uv1.empty() ||
           !mesh.colors.empty();
}

glm::vec3 transform_point(const glm::dmat4& m, const glm::vec3& p) {
    return glm::vec3(m * glm::dvec4(p, 1.0));
}

void grow_transformed(Box& box, const glm::dmat4& m, const Box& local) {
    for (int corner = 0; corner < 8; ++corner)
        box.grow(glm::vec3(m * glm::dvec4(corner_of(local, corner), 1)));
}

// Outward by a rounding step, so that float boxes hold what the doubles say.
Box widened(Box box) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 3; ++i) {
        box.lo[i] = std::nextafter(std::nextafter(box.lo[i], -infinity), -infinity);
        box.hi[i] = std::nextafter(std::nextafter(box.hi[i], infinity), infinity);
    }
    return box;
}

Box mesh_bounds(const MeshDescription& mesh) {
    Box box;
    for (const glm::vec3& p : mesh.positions) box.grow(p);
    return box;
}

Box triangle_box(const PrimitiveRecord& p) {
    Box box;
    box.grow(p.v0), box.grow(p.v1), box.grow(p.v2);
    return box;
}

class Builder {
  public:
    Builder(const SceneDescription& scene, World& world, unsigned threads)
        : scene_(scene), world_(world), threads_(threads) {}

    // The mesh's vertices as attributes of the device; returns the index of the first.
    uint32_t add_vertices(const MeshDescription& mesh, const glm::dmat4& world_from_local) {
        const uint32_t first = uint32_t(world_.vertices.size());
        const glm::dmat3 linear(world_from_local);
        const glm::dmat3 normals = glm::inverse(glm::transpose(linear));
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            VertexRecord v{};
            if (!mesh.normals.empty()) {
                const glm::dvec3 n = normals * glm::dvec3(mesh.normals[i]);
                if (const double length = glm::length(n); length > 0) v.normal = glm::vec3(n / length);
            }
            if (!mesh.tangents.empty()) {
                const glm::dvec3 t = linear * glm::dvec3(mesh.tangents[i]);
                // A mirrored mesh turns the handedness of its frames.
                const float sign = glm::determinant(linear) < 0 ? -1.0f : 1.0f;
                if (const double length = glm::length(t); length > 0)
                    v.tangent = glm::vec4(glm::vec3(t / length), mesh.tangents[i].w * sign);
            }
            if (!mesh.uv0.empty()) v.uv0 = mesh.uv0[i];
            if (!mesh.uv1.empty()) v.uv1 = mesh.uv1[i];
            v.color =
                mesh.colors.empty() ? 0xFFFFFFFFu : glm::packUnorm4x8(glm::clamp(mesh.colors[i], 0.0f, 1.0f));
            world_.vertices.push_back(v);
        }
        return first;
    }

    // Appends the mesh's triangles, in the frame that `to_frame` leads to.
    void add_triangles(const MeshDescription& mesh, const glm::dmat4& to_frame,
                       std::vector<PrimitiveRecord>& out) {
        const bool attributes = has_attributes(mesh);
        if (attributes && world_.vertices.empty()) world_.vertices.push_back({{}, 0xFFFFFFFFu, {}, {}, {}});
        const uint32_t first_vertex = attributes ? add_vertices(mesh, to_frame) : 0;
        const bool mirrored = glm::determinant(glm::dmat3(to_frame)) < 0;
        std::vector<glm::vec3> positions(mesh.positions.size());
        for (size_t i = 0; i < positions.size(); ++i)
            positions[i] = transform_point(to_frame, mesh.positions[i]);
        out.reserve(out.size() + mesh.triangles.size());
        for (glm::uvec3 t : mesh.triangles) {
            if (mirrored) std::swap(t.y, t.z);  // the front stays the front
            PrimitiveRecord p{positions[t.x], mesh.material, positions[t.y], no_record, positions[t.z], 0};
            if (triangle_area_vanishes(p)) continue;
            p.attributes = uint32_t(world_.triangle_indices.size());
            if (!mesh.normals.empty() && !shading_normals_)
                for (uint32_t i : {t.x, t.y, t.z})
                    shading_normals_ |= is_another_normal(p, world_.vertices[first_vertex + i].normal);
            if (keep_indices_)
                world_.triangle_indices.push_back(attributes ? t + first_vertex : glm::uvec3(0));
            out.push_back(p);
        }
        world_.triangles += mesh.triangles.size();
    }

    // A tree over `primitives`, which are appended to the world's in leaf order, `order`, and twins behind
    // them. Returns the tree's header.
    uint32_t add_tree(const std::vector<PrimitiveRecord>& primitives, std::vector<Box> boxes,
                      std::vector<uint32_t>* order = nullptr) {
        const std::vector<uint32_t> twins = find_twins(primitives, scene_.materials);
        std::vector<uint32_t> kept;
        for (uint32_t i = 0; i < primitives.size(); ++i)
            if (twins[i] >= i) boxes[kept.size()] = boxes[i], kept.push_back(i);
        boxes.resize(kept.size());
        const Bvh bvh = build_bvh(boxes, threads_);
        const uint32_t first = uint32_t(world_.primitives.size());
        const uint32_t header = encode_bvh(bvh, first, world_.nodes);
        world_.primitives.reserve(first + primitives.size());
        std::vector<uint32_t> all;
        for (uint32_t i : bvh.order) world_.primitives.push_back(primitives[kept[i]]), all.push_back(kept[i]);
        world_.twins.resize(first + primitives.size(), no_record);
        for (uint32_t i = 0; i < kept.size(); ++i) {
            const uint32_t twin = twins[all[i]];
            if (twin == no_record) continue;
            world_.twins[first + i] = uint32_t(world_.primitives.size());
            PrimitiveRecord p = primitives[twin];
            turn_to(primitives[all[i]], p, keep_indices_ ? &world_.triangle_indices[p.attributes] : nullptr);
            world_.primitives.push_back(p), all.push_back(twin);
            has_twins_ = true;
        }
        if (order) *order = std::move(all);
        const double seconds = world_.statistics.seconds + bvh.statistics.seconds;
        const uint32_t depth = std::max(world_.statistics.depth, bvh.statistics.depth);
        if (first == 0) world_.statistics = bvh.statistics;
        world_.statistics.seconds = seconds;
        world_.statistics.depth = depth;
        return header;
    }

    void keep_indices(bool keep) { keep_indices_ = keep; }
    bool has_shading_normals() const { return shading_normals_; }
    bool has_twins() const { return has_twins_; }

  private:
    // What transforming to floats has made of a thin triangle; it could be hit by nothing.
    static bool triangle_area_vanishes(const PrimitiveRecord& p) {
        return p.v0 == p.v1 || p.v1 == p.v2 || p.v0 == p.v2;
    }

    // Whether a vertex normal, of whichever side, is more than 0.0014 rad off that of the triangle.
    static bool is_another_normal(const PrimitiveRecord& p, const glm::dvec3& normal) {
        const glm::dvec3 n = glm::cross(glm::dvec3(p.v1 - p.v0), glm::dvec3(p.v2 - p.v0));
        return normal != glm::dvec3(0) && std::abs(glm::dot(n, normal)) < (1 - 1e-6) * glm::length(n);
    }

    const SceneDescription& scene_;
    World& world_;
    unsigned threads_;
    bool keep_indices_ = false;
    bool shading_normals_ = false, has_twins_ = false;
};

}  // namespace

TransformRecord transform_record(const glm::dmat4& world_from_local) {
    TransformRecord record;
    const glm::dmat4 inverse = glm::inverse(world_from_local);
    for (int column = 0; column < 4; ++column) {
        record.world_from_local[column] = glm::vec3(world_from_local[column]);
        record.local_from_world[column] = glm::vec3(inverse[column]);
    }
    return record;
}

World build_world(const SceneDescription& scene, const std::vector<ShapePart>& parts, unsigned threads,
                  Features& features) {
    World world;
    std::vector<Box> shape_bounds(scene.shapes.size());
    std::vector<size_t> first_part(scene.shapes.size() + 1, parts.size());
    for (size_t i = parts.size(); i-- > 0;) {
        shape_bounds[parts[i].shape].grow(parts[i].bounds);
        first_part[parts[i].shape] = i;
    }
    Builder builder(scene, world, threads);
    std::vector<uint32_t> all_placed;
    std::vector<Box> local_bounds;
    for (const MeshDescription& mesh : scene.meshes) local_bounds.push_back(mesh_bounds(mesh));
    std::vector<uint32_t> uses(scene.meshes.size());
    for (const MeshInstance& instance : scene.instances) ++uses[instance.mesh];
    const std::vector<bool> watched = all_watched(scene);
    std::vector<bool> watched_meshes(scene.meshes.size());
    for (size_t i = 0; i < watched.size(); ++i)
        if (watched[i]) watched_meshes[scene.instances[i].mesh] = true;
    const auto merged = [&](uint32_t mesh) {
        return uses[mesh] == 1 || watched_meshes[mesh] ||
               scene.materials[scene.meshes[mesh].material].emission ||
               scene.meshes[mesh].triangles.size() * uint64_t(uses[mesh]) <= small_mesh_triangles;
    };
    features.vertex_attributes =
        std::any_of(scene.instances.begin(), scene.instances.end(),
                    [&](const MeshInstance& i) { return has_attributes(scene.meshes[i.mesh]); });
    builder.keep_indices(features.vertex_attributes);
    const Placing placing(scene, shape_bounds, local_bounds);
    world.center = placing.center();

    // A tree for the scene, whose places are relative to its centre, and one for each content.
    for (uint32_t content = 0; content <= scene.contents.size(); ++content) {
        const glm::dmat4 recentre =
            content == 0 ? glm::translate(glm::dmat4(1.0), -world.center) : glm::dmat4(1.0);
        std::vector<PrimitiveRecord> primitives;
        std::vector<uint32_t> placed;
        for (const uint32_t i : placing.instances(content)) {
            const MeshInstance& instance = scene.instances[i];
            if (merged(instance.mesh))
                builder.add_triangles(scene.meshes[instance.mesh], recentre * instance.world_from_local,
                                      primitives);
            placed.resize(primitives.size(), i);
        }
        placing.add_boundaries(content, recentre, primitives, placed);
        std::vector<Box> boxes;
        boxes.reserve(primitives.size());
        for (const PrimitiveRecord& p : primitives) boxes.push_back(triangle_box(p));
        features.triangles |= !primitives.empty();

        // With the transform that comes next.
        const auto place = [&](const glm::dmat4& world_from_local, PrimitiveKind kind, uint32_t word,
                               uint32_t material, const Box& local) {
            PrimitiveRecord p{};
            p.v0.x = std::bit_cast<float>(word);
            p.v0.y = std::bit_cast<float>(uint32_t(world.transforms.size()));
            p.material = material;
            p.light = no_record;
            p.attributes = uint32_t(kind) << 30;
            primitives.push_back(p);
            Box box;
            grow_transformed(box, world_from_local, local);
            boxes.push_back(widened(box));
        };
        for (const uint32_t i : placing.shapes(content)) {
            const glm::dmat4 world_from_local = recentre * scene.shapes[i].world_from_local;
            for (size_t k = first_part[i]; k < first_part[i + 1]; ++k) {
                place(world_from_local, PrimitiveKind::shape, parts[k].ref, scene.shapes[i].material,
                      parts[k].bounds);
                placed.push_back(uint32_t(scene.instances.size() + i));
            }
            world.transforms.push_back(transform_record(world_from_local));
            features.shapes = true;
        }
        // Instances point to the header of their mesh's tree, which is built behind the world's: patched
        // below.
        for (const uint32_t i : placing.instances(content)) {
            const MeshInstance& instance = scene.instances[i];
            if (!merged(instance.mesh) && !local_bounds[instance.mesh].empty()) {
                place(recentre * instance.world_from_local, PrimitiveKind::instance, instance.mesh, 0,
                      local_bounds[instance.mesh]);
                world.transforms.push_back(transform_record(recentre * instance.world_from_local));
                placed.push_back(i);
                features.instances = true;
                ++world.instances;
            }
        }

        if (content == 0)
            for (const Box& box : boxes) world.bounds.grow(box);
        std::vector<uint32_t> order;
        world.headers.push_back(builder.add_tree(primitives, boxes, &order));
        if (content == 0) world.sources = order;
        for (const uint32_t i : order) all_placed.push_back(placed[i]);
        world.contents.resize(all_placed.size(), content);
    }
    world.placed = std::make_shared<const std::vector<uint32_t>>(std::move(all_placed));
    world.world_primitives = uint32_t(world.primitives.size());

    std::vector<uint32_t> headers(scene.meshes.size(), no_record);
    for (uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (uses[mesh] == 0 || merged(mesh) || local_bounds[mesh].empty()) continue;
        std::vector<PrimitiveRecord> triangles;
        builder.add_triangles(scene.meshes[mesh], glm::dmat4(1.0), triangles);
        std::vector<Box> triangle_boxes;
        for (const PrimitiveRecord& p : triangles) triangle_boxes.push_back(triangle_box(p));
        headers[mesh] = builder.add_tree(triangles, triangle_boxes);
        features.triangles = true;
    }
    features.shading_normals = builder.has_shading_normals();
    features.twins = builder.has_twins();
    if (!features.twins) world.twins.clear();
    for (uint32_t i = 0; i < world.world_primitives; ++i)
        if (primitive_kind(world.primitives[i]) == PrimitiveKind::instance)
            world.primitives[i].v0.x =
                std::bit_cast<float>(headers[std::bit_cast<uint32_t>(world.primitives[i].v0.x)]);
    return world;
}

}  // namespace etendue
