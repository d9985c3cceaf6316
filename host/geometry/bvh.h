// Bounding volume hierarchies: built here, walked by shaders/lib/traversal.glsl.
//
// build_bvh makes a binary tree by binned surface-area heuristic (Wald 2007), the same for any number of
// threads. encode_bvh writes it as the device reads it (layout: shaders/lib/bvh.glsl): 32-byte nodes whose
// bounds are 16-bit steps of a grid over the whole tree, or 64-byte nodes with float bounds.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

namespace etendue {

struct Box {
    glm::vec3 lo{std::numeric_limits<float>::infinity()};
    glm::vec3 hi{-std::numeric_limits<float>::infinity()};

    void grow(const Box& other) { lo = glm::min(lo, other.lo), hi = glm::max(hi, other.hi); }
    void grow(const glm::vec3& point) { lo = glm::min(lo, point), hi = glm::max(hi, point); }
    bool empty() const { return !(lo.x <= hi.x); }
};

// A child is an inner node's index, or a leaf: bit 31, count - 1 in bits 29 and 30, first primitive in leaf
// order.
using BvhReference = uint32_t;
constexpr BvhReference bvh_leaf_bit = 0x80000000u;
constexpr BvhReference bvh_nothing = 0xFFFFFFFEu;  // the root of a tree without primitives
constexpr uint32_t bvh_max_leaf = 4;
constexpr uint32_t bvh_max_depth = 48;  // inner nodes on any way down: what traversal must be able to stack
constexpr uint32_t bvh_first_mask = (1u << 29) - 1;
constexpr uint32_t bvh_max_primitives = bvh_first_mask - 8;  // keeps bvh_nothing apart from every leaf

constexpr bool bvh_is_leaf(BvhReference r) { return (r & bvh_leaf_bit) != 0; }
constexpr uint32_t bvh_leaf_first(BvhReference r) { return r & bvh_first_mask; }
constexpr uint32_t bvh_leaf_count(BvhReference r) { return ((r >> 29) & 3u) + 1; }
constexpr BvhReference bvh_leaf(uint32_t first, uint32_t count) {
    return bvh_leaf_bit | ((count - 1) << 29) | first;
}

struct BvhNode {
    Box bounds[2];
    BvhReference child[2];
};

struct BvhStatistics {
    double sah_cost =
        0;  // expected node visits plus primitive tests of a random ray that meets the root's box
    uint32_t depth = 0;  // inner nodes on the longest way down
    uint32_t nodes = 0, leaves = 0;
    double seconds = 0;
};

struct Bvh {
    std::vector<BvhNode> nodes;   // depth-first; nodes[0] is the root if there is any inner node
    std::vector<uint32_t> order;  // leaf order: order[i] is the primitive that stands i-th
    Box bounds;
    BvhReference root = bvh_nothing;
    BvhStatistics statistics;
};

struct BvhSettings {
    uint32_t max_leaf = bvh_max_leaf;  // primitives a leaf may hold, 1 to bvh_max_leaf
    float primitive_cost = 1.5f;       // of one primitive test, in node visits
};

// Boxes must be finite and not inverted (they may be points). Throws Error for more than bvh_max_primitives.
Bvh build_bvh(std::span<const Box> boxes, unsigned threads, BvhSettings settings = {});

constexpr uint32_t bvh_header_entries = 2;

// Appends the tree to the `nodes` buffer's entries as the device reads them, and returns the entry of its
// header, where a traversal starts. `first_primitive`: where in `primitives` its first one stands.
uint32_t encode_bvh(const Bvh& bvh, uint32_t first_primitive, std::vector<glm::uvec4>& entries);

// Share of the leaves whose boxes more than double in area by rounding to the 16-bit grid: rays
// that go there test primitives for nothing.
double coarse_share(const Bvh& bvh);

}  // namespace etendue
