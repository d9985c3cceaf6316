// A density as shaders/lib/density_grid.glsl reads it: bricks of 4 x 4 x 4 cells, those that vary with their
// values.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/density_grid.h"

namespace etendue {

constexpr uint32_t brick_cells = 4;  // along each axis

// Twins of structs in shaders/lib/density_grid.glsl.
struct DensityGridRecord {
    glm::vec3 lattice_from_world[4];  // columns
    glm::uvec3 cells;
    uint32_t first_brick;
};
struct DensityBrickRecord {
    float least, greatest, mean;
    uint32_t first_value;
};

// Of all densities of a scene, one behind the other.
struct DensityBricks {
    std::vector<DensityBrickRecord> bricks;
    std::vector<float> values;
};

// Appends a lattice; returns its cells and where its bricks begin. `where` begins the message about values
// that are no densities.
DensityGridRecord add_bricks(DensityBricks& bricks, const DensityLattice& lattice, const std::string& where);

}  // namespace etendue
