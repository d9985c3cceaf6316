#include <algorithm>
#include <bit>
#include <cmath>

#include "host/geometry/bvh.h"

namespace etendue {
namespace {

constexpr double grid_steps = 65535;

// The grid of a tree: a bound b along an axis becomes (b - lo) * inverse_cell, rounded outward to 0 … 65535.
struct Grid {
    glm::vec3 lo{0}, inverse_cell{1};
    float extent = 0;  // largest, m

    explicit Grid(const Box& bounds) {
        if (bounds.empty()) return;
        lo = bounds.lo;
        const glm::dvec3 size = glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo);
        const double largest = std::max({size.x, size.y, size.z});
        extent = std::nextafter(static_cast<float>(largest), std::numeric_limits<float>::infinity());
        for (int axis = 0; axis < 3; axis++) {
            // A flat axis gets a cell that float coordinates can still tell apart.
            const double s = std::max({size[axis], 1e-6 * largest, 1e-20});
            inverse_cell[axis] = static_cast<float>(grid_steps / s * (1 - 1e-6));
        }
    }
    double place(float b, int axis) const {
        return (static_cast<double>(b) - static_cast<double>(lo[axis])) *
               static_cast<double>(inverse_cell[axis]);
    }
    uint32_t down(float b, int axis) const {
        return static_cast<uint32_t>(std::clamp(std::floor(place(b, axis) - 1e-9), 0.0, grid_steps));
    }
    uint32_t up(float b, int axis) const {
        return static_cast<uint32_t>(std::clamp(std::ceil(place(b, axis) + 1e-9), 0.0, grid_steps));
    }
};

}  // namespace

uint32_t encode_bvh(const Bvh& bvh, uint32_t first_primitive, std::vector<glm::uvec4>& entries) {
    const auto header = static_cast<uint32_t>(entries.size());
    constexpr uint32_t node_entries = 2;
    const uint32_t base = header + bvh_header_entries;
    const auto moved = [&](BvhReference r) {
        if (r == bvh_nothing) return r;
        return bvh_is_leaf(r) ? r + first_primitive : base + r * node_entries;
    };
    const auto bits = [](const glm::vec3& v) {
        return glm::uvec3(std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y),
                          std::bit_cast<uint32_t>(v.z));
    };
    const Grid grid(bvh.bounds);
    entries.reserve(base + bvh.nodes.size() * node_entries);
    entries.emplace_back(bits(grid.lo), moved(bvh.root));
    entries.emplace_back(bits(grid.inverse_cell), std::bit_cast<uint32_t>(grid.extent));
    for (const BvhNode& node : bvh.nodes) {
        for (int i = 0; i < 2; i++) {
            const Box& box = node.bounds[i];
            glm::uvec3 words;
            for (int axis = 0; axis < 3; axis++)
                words[axis] = grid.down(box.lo[axis], axis) | grid.up(box.hi[axis], axis) << 16;
            entries.emplace_back(words, moved(node.child[i]));
        }
    }
    return header;
}

double coarse_share(const Bvh& bvh) {
    const Grid grid(bvh.bounds);
    uint64_t leaves = 0, coarse = 0;
    for (const BvhNode& node : bvh.nodes) {
        for (int i = 0; i < 2; i++) {
            if (!bvh_is_leaf(node.child[i])) continue;
            glm::dvec3 d, q;
            for (int axis = 0; axis < 3; axis++) {
                const float lo = node.bounds[i].lo[axis], hi = node.bounds[i].hi[axis];
                d[axis] = static_cast<double>(hi) - static_cast<double>(lo);
                q[axis] = static_cast<double>(grid.up(hi, axis) - grid.down(lo, axis)) /
                          static_cast<double>(grid.inverse_cell[axis]);
            }
            leaves++;
            coarse += q.x * q.y + q.y * q.z + q.z * q.x > 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
        }
    }
    return leaves > 0 ? static_cast<double>(coarse) / static_cast<double>(leaves) : 0.0;
}

}  // namespace etendue
