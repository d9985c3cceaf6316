// The scene's geometry as the device holds it: one hierarchy over world triangles, analytic shapes and
// instances, and one for what each optical element holds, in its frame.
//
// Meshes used once, or emissive, or small, or with a meter on their surface, are transformed to world space
// and merged; the others keep a hierarchy of their own and are placed by instances. World coordinates are
// relative to `center`, so that a scene far from its origin keeps its digits.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "host/geometry/bvh.h"
#include "host/scene/description.h"
#include "host/scene/features.h"

namespace etendue {

// Twins of structs in shaders/geometry/triangle.glsl, lib/bvh.glsl and lib/primitives.glsl; a test compares
// the layouts.
struct PrimitiveRecord {
    glm::vec3 v0;
    uint32_t material;
    glm::vec3 v1;
    uint32_t light;
    glm::vec3 v2;
    uint32_t attributes;
};
struct TransformRecord {
    glm::vec3 world_from_local[4], local_from_world[4];  // columns
};
struct VertexRecord {
    glm::vec3 normal;  // zero = none
    uint32_t color;
    glm::vec4 tangent;
    glm::vec2 uv0, uv1;
};

struct World {
    glm::dvec3 center{0};
    Box bounds;
    // Leaf order, one tree behind the other: that of the scene, those of the contents of elements, those of
    // instanced meshes.
    std::vector<PrimitiveRecord> primitives;
    uint32_t world_primitives = 0;   // all but those of instanced meshes
    std::vector<uint32_t> headers;   // of the trees of the scene and of the contents, in `nodes`
    std::vector<uint32_t> contents;  // of each world primitive: 0 = the scene, i = content i - 1
    // Of the world's primitives: what they are of, counted through the scene's instances, its shapes, and the
    // elements whose boundaries they are (of a content's own boundary the first that holds it).
    std::shared_ptr<const std::vector<uint32_t>> placed;
    std::vector<uint32_t> sources;  // of the same: their places in the order of scene and meshes
    std::vector<uint32_t> twins;    // of each primitive: the other side of its sheet (twins.h), or no_record
    std::vector<glm::uvec4> nodes;
    std::vector<TransformRecord> transforms;
    std::vector<VertexRecord> vertices;
    std::vector<glm::uvec3> triangle_indices;
    uint64_t triangles = 0;    // in memory
    uint64_t instances = 0;    // placed meshes that kept their own hierarchy
    BvhStatistics statistics;  // of the world's tree; seconds of all
};

enum class PrimitiveKind : uint32_t { triangle = 0, shape = 1, instance = 2, boundary = 3 };
constexpr PrimitiveKind primitive_kind(const PrimitiveRecord& p) { return PrimitiveKind(p.attributes >> 30); }

// What rays meet of a shape: all of it, or one of the pieces that the host has cut it into.
struct ShapePart {
    uint32_t shape = 0;  // index into SceneDescription::shapes
    uint32_t ref = 0;    // RecordRef of its geometry
    Box bounds;          // in the shape's frame
};

// `parts`: of scene.shapes, in their order, at least one each. Sets the geometry's features.
World build_world(const SceneDescription& scene, const std::vector<ShapePart>& parts, unsigned threads,
                  Features& features);

TransformRecord transform_record(const glm::dmat4& world_from_local);

}  // namespace etendue
