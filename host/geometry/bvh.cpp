#include "host/geometry/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <numeric>

#include "host/error.h"
#include "host/parallel_for.h"

namespace etendue {
namespace {

constexpr int bins = 32;
constexpr uint32_t sweep_size = 16;  // ranges up to this size try every split instead of binning

struct Item {  // what the builder moves about: 28 bytes a primitive
    Box box;
    uint32_t index;
};

struct Range {
    uint32_t begin = 0, end = 0;
    uint32_t depth = 0;  // inner nodes above
    Box bounds;          // of the items
    uint32_t size() const { return end - begin; }
};

glm::vec3 center2(const Box& box) { return box.lo + box.hi; }  // twice the centre

double half_area(const Box& box) {
    if (box.empty()) return 0;
    const glm::dvec3 d = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Levels of inner nodes that a balanced subtree of n primitives needs.
uint32_t levels_needed(uint32_t n, uint32_t max_leaf) {
    const uint32_t leaves = (n + max_leaf - 1) / max_leaf;
    return leaves <= 1 ? 0 : static_cast<uint32_t>(std::bit_width(leaves - 1)) + 1;
}

struct Split {
    double cost = std::numeric_limits<double>::infinity();
    int axis = -1;
    int bin = 0;  // items in bins below it go left
};

// Binned SAH over the three axes (Wald 2007, "On fast Construction of SAH-based Bounding Volume
// Hierarchies").
Split binned_split(std::span<const Item> items, const Box& centers) {
    struct Bin {
        Box box;
        uint32_t count = 0;
    };
    std::array<std::array<Bin, bins>, 3> all{};
    const glm::vec3 extent = centers.hi - centers.lo;
    glm::vec3 scale;
    for (int axis = 0; axis < 3; axis++) {
        scale[axis] = bins / extent[axis];
        if (!std::isfinite(scale[axis])) scale[axis] = 0;
    }
    for (const Item& item : items) {
        const glm::vec3 place = (center2(item.box) - centers.lo) * scale;
        for (int axis = 0; axis < 3; axis++) {
            Bin& bin = all[axis][std::clamp(static_cast<int>(place[axis]), 0, bins - 1)];
            bin.box.grow(item.box);
            bin.count++;
        }
    }
    Split best;
    for (int axis = 0; axis < 3; axis++) {
        if (scale[axis] == 0) continue;
        const auto& row = all[axis];
        std::array<double, bins> right_cost{};
        Box box;
        uint32_t count = 0;
        for (int i = bins - 1; i > 0; i--) {
            box.grow(row[i].box), count += row[i].count;
            right_cost[i] = half_area(box) * count;
        }
        box = Box{}, count = 0;
        for (int i = 1; i < bins; i++) {
            box.grow(row[i - 1].box), count += row[i - 1].count;
            if (count == 0 || count == items.size()) continue;
            const double cost = half_area(box) * count + right_cost[i];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }
    return best;
}

// Every split along every axis, for few items. Leaves them sorted along the best axis, and says where to cut.
struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    uint32_t left = 0;
};
Cut sweep_split(std::span<Item> items) {
    const auto sort_along = [&](int axis) {
        std::sort(items.begin(), items.end(), [axis](const Item& a, const Item& b) {
            const float ca = center2(a.box)[axis], cb = center2(b.box)[axis];
            return ca != cb ? ca < cb : a.index < b.index;
        });
    };
    Cut best;
    int best_axis = 2;
    const auto off_middle = [&](uint32_t i) {
        return std::abs(static_cast<int>(2 * i) - static_cast<int>(items.size()));
    };
    std::array<double, sweep_size> right_cost{};
    for (int axis = 0; axis < 3; axis++) {
        sort_along(axis);
        Box box;
        for (size_t i = items.size() - 1; i > 0; i--) {
            box.grow(items[i].box);
            right_cost[i] = half_area(box) * static_cast<double>(items.size() - i);
        }
        box = Box{};
        for (uint32_t i = 1; i < items.size(); i++) {
            box.grow(items[i - 1].box);
            const double cost = half_area(box) * i + right_cost[i];
            const bool more_even = cost == best.cost && off_middle(i) < off_middle(best.left);
            if (cost < best.cost || more_even) best = {cost, i}, best_axis = axis;
        }
    }
    if (best_axis != 2) sort_along(best_axis);
    return best;
}

struct Builder {
    std::vector<Item> items;
    BvhSettings settings;

    Box bounds_of(uint32_t begin, uint32_t end) const {
        Box box;
        for (uint32_t i = begin; i < end; i++) box.grow(items[i].box);
        return box;
    }

    // Halves the range along the widest axis of its centres: what is left when the heuristic has nothing to
    // say.
    uint32_t median_split(const Range& range, const Box& centers) {
        const glm::vec3 extent = centers.hi - centers.lo;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const uint32_t middle = range.begin + range.size() / 2;
        std::nth_element(items.begin() + range.begin, items.begin() + middle, items.begin() + range.end,
                         [axis](const Item& a, const Item& b) {
                             const float ca = center2(a.box)[axis], cb = center2(b.box)[axis];
                             return ca != cb ? ca < cb : a.index < b.index;
                         });
        return middle;
    }

    // Splits the range in two; false if it shall be a leaf.
    bool split(const Range& range, Range& left, Range& right) {
        const uint32_t n = range.size();
        if (n <= 1 || (n <= settings.max_leaf && range.depth >= bvh_max_depth)) return false;
        const std::span<Item> span(items.data() + range.begin, n);
        const double leaf_cost = settings.primitive_cost * n * half_area(range.bounds);
        const auto worth_it = [&](double cost) {  // against a leaf
            return half_area(range.bounds) + settings.primitive_cost * cost < leaf_cost;
        };
        uint32_t middle = range.begin;
        if (n <= sweep_size) {
            const Cut cut = sweep_split(span);
            if (n <= settings.max_leaf && !worth_it(cut.cost)) return false;
            middle = range.begin + (cut.left > 0 ? cut.left : n / 2);
        } else {
            Box centers;
            for (const Item& item : span) centers.grow(center2(item.box));
            const Split best = binned_split(span, centers);
            if (best.axis >= 0) {
                const float lo = centers.lo[best.axis];
                const float scale = bins / (centers.hi[best.axis] - lo);
                const auto is_left = [&](const Item& item) {
                    const float place = (center2(item.box)[best.axis] - lo) * scale;
                    return std::clamp(static_cast<int>(place), 0, bins - 1) < best.bin;
                };
                middle +=
                    static_cast<uint32_t>(std::partition(span.begin(), span.end(), is_left) - span.begin());
            }
            if (middle == range.begin || middle == range.end) middle = median_split(range, centers);
        }
        // The depth bound: a child that would not fit below with balanced splits is not made.
        const uint32_t room = bvh_max_depth - range.depth - 1;
        const uint32_t larger = std::max(middle - range.begin, range.end - middle);
        if (levels_needed(larger, settings.max_leaf) > room) {
            Box centers;
            for (const Item& item : span) centers.grow(center2(item.box));
            middle = median_split(range, centers);
        }
        left = {range.begin, middle, range.depth + 1, bounds_of(range.begin, middle)};
        right = {middle, range.end, range.depth + 1, bounds_of(middle, range.end)};
        return true;
    }

    // The subtree over `range`, its inner nodes appended to `nodes` depth-first. Returns the reference, with
    // node indices relative to `nodes`.
    BvhReference build(const Range& range, std::vector<BvhNode>& nodes, BvhStatistics& statistics) {
        Range child[2];
        if (!split(range, child[0], child[1])) {
            statistics.leaves++;
            return bvh_leaf(range.begin, range.size());
        }
        statistics.depth = std::max(statistics.depth, range.depth + 1);
        const auto index = static_cast<uint32_t>(nodes.size());
        nodes.push_back({{child[0].bounds, child[1].bounds}, {0, 0}});
        for (int i = 0; i < 2; i++) {
            const BvhReference reference = build(child[i], nodes, statistics);
            nodes[index].child[i] = reference;
        }
        return index;
    }
};

// The top of the tree, split until the ranges are small enough to share out; both halves of every split are
// worked on in parallel. What is split depends on the primitives alone, never on the threads.
struct TopNode {
    Range range;
    int32_t child[2] = {-1, -1};  // both or none; none: a subtree of its own
};

double tree_cost(const Bvh& bvh, const BvhSettings& settings) {
    const double root = half_area(bvh.bounds);
    if (bvh.nodes.empty() || !(root > 0))
        return settings.primitive_cost * static_cast<double>(bvh.order.size());
    double cost = root;
    for (const BvhNode& node : bvh.nodes)
        for (int i = 0; i < 2; i++)
            cost +=
                half_area(node.bounds[i]) *
                (bvh_is_leaf(node.child[i]) ? settings.primitive_cost * bvh_leaf_count(node.child[i]) : 1.0);
    return cost / root;
}

}  // namespace

Bvh build_bvh(std::span<const Box> boxes, unsigned threads, BvhSettings settings) {
    const auto start = std::chrono::steady_clock::now();
    if (boxes.size() > bvh_max_primitives)
        fail_input("{} primitives in one hierarchy; at most {} are allowed", boxes.size(),
                   bvh_max_primitives);
    settings.max_leaf = std::clamp(settings.max_leaf, 1u, bvh_max_leaf);

    Bvh bvh;
    const auto n = static_cast<uint32_t>(boxes.size());
    Builder builder{{}, settings};
    builder.items.resize(n);
    for (uint32_t i = 0; i < n; i++) builder.items[i] = {boxes[i], i};
    bvh.bounds = builder.bounds_of(0, n);
    if (n == 0) return bvh;

    std::vector<TopNode> top{{Range{0, n, 0, bvh.bounds}}};
    const uint32_t share = std::max(n / 64, 4096u);
    for (size_t begin = 0; begin < top.size();) {
        const size_t end = top.size();
        std::vector<std::array<Range, 2>> halves(end - begin);
        std::vector<char> is_split(end - begin, 0);
        parallel_for(end - begin, threads, [&](size_t i) {
            const Range& range = top[begin + i].range;
            if (range.size() > share) is_split[i] = builder.split(range, halves[i][0], halves[i][1]);
        });
        for (size_t i = 0; i < halves.size(); i++) {
            if (!is_split[i]) continue;
            for (int side = 0; side < 2; side++) {
                top[begin + i].child[side] = static_cast<int32_t>(top.size());
                top.push_back({halves[i][side]});
            }
        }
        begin = end;
    }

    struct Subtree {
        std::vector<BvhNode> nodes;
        BvhReference root = bvh_nothing;
        BvhStatistics statistics;
    };
    std::vector<Subtree> subtrees(top.size());
    parallel_for(top.size(), threads, [&](size_t i) {
        if (top[i].child[0] >= 0) return;
        subtrees[i].root = builder.build(top[i].range, subtrees[i].nodes, subtrees[i].statistics);
    });

    size_t total = 0;
    for (size_t i = 0; i < top.size(); i++) total += subtrees[i].nodes.size() + (top[i].child[0] >= 0);
    bvh.nodes.reserve(total);
    const auto join = [&](const auto& self, size_t i) -> BvhReference {
        const auto base = static_cast<uint32_t>(bvh.nodes.size());
        if (top[i].child[0] >= 0) {
            const TopNode node = top[i];
            bvh.nodes.push_back({{top[node.child[0]].range.bounds, top[node.child[1]].range.bounds}, {0, 0}});
            bvh.statistics.depth = std::max(bvh.statistics.depth, node.range.depth + 1);
            for (int side = 0; side < 2; side++) {
                const BvhReference reference = self(self, node.child[side]);
                bvh.nodes[base].child[side] = reference;
            }
            return base;
        }
        Subtree subtree = std::move(subtrees[i]);
        bvh.statistics.depth = std::max(bvh.statistics.depth, subtree.statistics.depth);
        bvh.statistics.leaves += subtree.statistics.leaves;
        for (BvhNode& node : subtree.nodes)
            for (BvhReference& child : node.child)
                if (!bvh_is_leaf(child)) child += base;
        bvh.nodes.insert(bvh.nodes.end(), subtree.nodes.begin(), subtree.nodes.end());
        return bvh_is_leaf(subtree.root) ? subtree.root : subtree.root + base;
    };
    bvh.root = join(join, 0);

    bvh.order.resize(n);
    for (uint32_t i = 0; i < n; i++) bvh.order[i] = builder.items[i].index;
    bvh.statistics.nodes = static_cast<uint32_t>(bvh.nodes.size());
    bvh.statistics.sah_cost = tree_cost(bvh, settings);
    bvh.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

}  // namespace etendue
