#include "host/scene/cell_mesh.h"

#include "host/geometry/bvh.h"

namespace etendue {
namespace {

// Appends a subtree, parents first.
void add_subtree(const Bvh& bvh, BvhReference reference, const Box& box, std::vector<CellNode>& nodes,
                 size_t first_node) {
    const size_t own = nodes.size();
    nodes.push_back({box.lo, 0, box.hi, 0});
    if (bvh_is_leaf(reference))
        nodes[own].leaf = bvh_leaf_first(reference) << 3 | bvh_leaf_count(reference);
    else
        for (int side = 0; side < 2; ++side)
            add_subtree(bvh, bvh.nodes[reference].child[side], bvh.nodes[reference].bounds[side], nodes,
                        first_node);
    nodes[own].behind = uint32_t(nodes.size() - first_node);
}

}  // namespace

CellMesh append_cell_mesh(const std::vector<glm::vec3>& corners, unsigned threads, CellTables& tables) {
    std::vector<Box> boxes(corners.size() / 3);
    Box bounds;
    for (size_t i = 0; i < corners.size(); ++i) boxes[i / 3].grow(corners[i]);
    for (const Box& box : boxes) bounds.grow(box);
    // A ray starts some cells away at most (geometry/microstructure.glsl).
    const glm::vec3 hair(4e-6f * glm::length(bounds.hi - bounds.lo));
    for (Box& box : boxes) box.lo -= hair, box.hi += hair;
    const Bvh bvh = build_bvh(boxes, threads);
    CellMesh mesh{0, uint32_t(tables.nodes.size()), uint32_t(tables.triangles.size()), bounds.lo.z,
                  bounds.hi.z};
    add_subtree(bvh, bvh.root, bvh.bounds, tables.nodes, tables.nodes.size());
    mesh.nodes = uint32_t(tables.nodes.size() - mesh.first_node);
    for (const uint32_t i : bvh.order)
        tables.triangles.push_back({corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]});
    return mesh;
}

}  // namespace etendue
