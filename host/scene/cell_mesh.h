// The triangles that stand in every cell of a microstructure, as the device walks through them
// (shaders/lib/cell_mesh.glsl).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace etendue {

// Twin of struct CellMesh in shaders/lib/cell_mesh.glsl.
struct CellMesh {
    uint32_t nodes = 0;
    uint32_t first_node = 0, first_triangle = 0;
    float low = 0, high = 0;  // m, along z
};

// Twins of structs in shaders/lib/cell_mesh.glsl.
struct CellNode {
    glm::vec3 lo;
    uint32_t behind;
    glm::vec3 hi;
    uint32_t leaf;
};
struct CellTriangle {
    glm::vec3 v0, v1, v2;
};

// Of all cells of a scene, one behind the other.
struct CellTables {
    std::vector<CellNode> nodes;
    std::vector<CellTriangle> triangles;
};

// Adds what `corners`, three a triangle in the frame of the cell, describe.
CellMesh append_cell_mesh(const std::vector<glm::vec3>& corners, unsigned threads, CellTables& tables);

}  // namespace etendue
