#include "host/scene/density_bricks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/error.h"

namespace etendue {
namespace {

constexpr uint32_t side = brick_cells + 1, brick_values = side * side * side;
constexpr uint32_t even = 0xFFFFFFFFu;  // no values: NO_RECORD

// The points of a brick, `count` of them along each axis; what lies beyond the lattice repeats its last
// points.
void spread(std::array<float, brick_values>& values, const std::vector<float>& read, glm::uvec3 count) {
    for (uint32_t z = 0, i = 0; z < side; ++z)
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x, ++i) {
                const glm::uvec3 p = glm::min(glm::uvec3(x, y, z), count - 1u);
                values[i] = read[(size_t(p.z) * count.y + p.y) * count.x + p.x];
            }
}

// Over the cells of the lattice within the brick: trilinear, so each point counts by the cells around it.
double mean_density(const std::vector<float>& read, glm::uvec3 count) {
    double sum = 0, weights = 0;
    const auto weight = [](uint32_t i, uint32_t n) { return i == 0 || i + 1 == n ? 0.5 : 1.0; };
    size_t i = 0;
    for (uint32_t z = 0; z < count.z; ++z)
        for (uint32_t y = 0; y < count.y; ++y)
            for (uint32_t x = 0; x < count.x; ++x, ++i) {
                const double w = weight(x, count.x) * weight(y, count.y) * weight(z, count.z);
                sum += w * read[i], weights += w;
            }
    return sum / weights;
}

}  // namespace

DensityGridRecord add_bricks(DensityBricks& bricks, const DensityLattice& lattice, const std::string& where) {
    DensityGridRecord grid{{}, lattice.points - 1u, uint32_t(bricks.bricks.size())};
    const glm::uvec3 counts = (grid.cells + brick_cells - 1u) / brick_cells;
    if (double(counts.x) * counts.y * counts.z + double(grid.first_brick) > 1 << 26)
        fail_input("{}: a grid of {} x {} x {} points is too large", where, lattice.points.x,
                   lattice.points.y, lattice.points.z);
    std::vector<float> read;
    std::array<float, brick_values> values;
    for (uint32_t bz = 0; bz < counts.z; ++bz)
        for (uint32_t by = 0; by < counts.y; ++by)
            for (uint32_t bx = 0; bx < counts.x; ++bx) {
                const glm::uvec3 first = brick_cells * glm::uvec3(bx, by, bz);
                const glm::uvec3 count = glm::min(glm::uvec3(side), lattice.points - first);
                read.resize(size_t(count.x) * count.y * count.z);
                lattice.read(first, count, read.data());
                for (const float v : read)
                    if (!(v >= 0) || v > 1e30f)
                        fail_input(
                            "{}: the density between the points ({}, {}, {}) and ({}, {}, {}) is {} at one; "
                            "allowed: finite numbers, at least 0",
                            where, first.x, first.y, first.z, first.x + count.x - 1, first.y + count.y - 1,
                            first.z + count.z - 1, v);
                const auto [least, greatest] = std::minmax_element(read.begin(), read.end());
                DensityBrickRecord brick{*least, *greatest, float(mean_density(read, count)), even};
                if (*least < *greatest) {
                    brick.first_value = uint32_t(bricks.values.size());
                    spread(values, read, count);
                    bricks.values.insert(bricks.values.end(), values.begin(), values.end());
                    if (bricks.values.size() >= even)
                        fail_input("{}: the densities of the scene take more than 16 GB", where);
                }
                bricks.bricks.push_back(brick);
            }
    return grid;
}

}  // namespace etendue
