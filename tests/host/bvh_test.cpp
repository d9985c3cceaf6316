#include "host/geometry/bvh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "host/error.h"
#include "tests/bench/interior.h"

using namespace etendue;

namespace {

std::vector<Box> random_boxes(size_t n, float size, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Box> boxes(n);
    for (Box& box : boxes) {
        const glm::vec3 center(uniform(random), uniform(random), uniform(random));
        box.grow(center);
        box.grow(center + size * glm::vec3(uniform(random), uniform(random), uniform(random)));
    }
    return boxes;
}

bool contains(const Box& outer, const Box& inner) {
    return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) &&
           glm::all(glm::greaterThanEqual(outer.hi, inner.hi));
}

// Walks the tree: every primitive in exactly one leaf, every box holds what is below it. Returns the depth.
uint32_t check_tree(const Bvh& bvh, std::span<const Box> boxes, uint32_t max_leaf = bvh_max_leaf) {
    std::vector<int> seen(boxes.size());
    uint32_t deepest = 0;
    bool sound = true;
    const auto walk = [&](const auto& self, BvhReference r, const Box& bounds, uint32_t depth) -> void {
        deepest = std::max(deepest, depth);
        if (bvh_is_leaf(r)) {
            sound = sound && bvh_leaf_count(r) <= max_leaf &&
                    bvh_leaf_first(r) + bvh_leaf_count(r) <= boxes.size();
            for (uint32_t i = 0; i < bvh_leaf_count(r) && sound; i++) {
                const uint32_t primitive = bvh.order[bvh_leaf_first(r) + i];
                seen[primitive]++;
                sound = sound && contains(bounds, boxes[primitive]);
            }
            return;
        }
        for (int i = 0; i < 2 && sound; i++) {
            sound = sound && contains(bounds, bvh.nodes[r].bounds[i]);
            self(self, bvh.nodes[r].child[i], bvh.nodes[r].bounds[i], depth + 1);
        }
    };
    if (!boxes.empty()) walk(walk, bvh.root, bvh.bounds, 0);
    CHECK(sound);
    CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
    CHECK(deepest == bvh.statistics.depth);
    CHECK(deepest <= bvh_max_depth);
    return deepest;
}

bool same(const Bvh& a, const Bvh& b) {
    const auto equal = [](const BvhNode& x, const BvhNode& y) {
        for (int i = 0; i < 2; i++)
            if (x.child[i] != y.child[i] || x.bounds[i].lo != y.bounds[i].lo ||
                x.bounds[i].hi != y.bounds[i].hi)
                return false;
        return true;
    };
    return a.root == b.root && a.order == b.order && a.nodes.size() == b.nodes.size() &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), equal);
}

}  // namespace

TEST_CASE("every primitive stands in one leaf and every box holds what is below it") {
    for (const size_t n : {1, 2, 3, 4, 5, 17, 1000, 30000}) {
        const std::vector<Box> boxes = random_boxes(n, 0.05f);
        check_tree(build_bvh(boxes, 2), boxes);
    }
}

TEST_CASE("a hierarchy over nothing has no root") {
    const Bvh bvh = build_bvh({}, 2);
    CHECK(bvh.root == bvh_nothing);
    CHECK(bvh.nodes.empty());
    std::vector<glm::uvec4> entries;
    CHECK(encode_bvh(bvh, 0, entries) == 0);
    CHECK(entries[0].w == bvh_nothing);
}

TEST_CASE("the tree is the same for any number of threads") {
    const std::vector<Box> boxes = random_boxes(100000, 0.02f);
    const Bvh one = build_bvh(boxes, 1);
    CHECK(same(one, build_bvh(boxes, 2)));
    CHECK(same(one, build_bvh(boxes, 7)));
}

TEST_CASE("identical boxes are halved down to leaves") {
    const std::vector<Box> boxes(5000, Box{glm::vec3(1), glm::vec3(2)});
    CHECK(check_tree(build_bvh(boxes, 2), boxes) <= 13);
}

TEST_CASE("points in one place make a tree of no extent") {
    const std::vector<Box> boxes(100, Box{glm::vec3(3), glm::vec3(3)});
    const Bvh bvh = build_bvh(boxes, 1);
    check_tree(bvh, boxes);
    std::vector<glm::uvec4> entries;
    encode_bvh(bvh, 0, entries);
    CHECK(std::isfinite(std::bit_cast<float>(entries[1].x)));
}

TEST_CASE("boxes in geometric progression stay within the depth that traversal can stack") {
    std::vector<Box> boxes;
    for (int repeat = 0; repeat < 20;
         repeat++) {  // one heuristic split each would peel off one scale after the other
        for (int i = -120; i < 120; i++) {
            const float x = std::ldexp(1.0f, i / 2);
            boxes.push_back({glm::vec3(x), glm::vec3(x * 1.25f)});
        }
    }
    check_tree(build_bvh(boxes, 2), boxes);
}

TEST_CASE("huge boxes whose areas overflow float still make a sound tree") {
    std::vector<Box> boxes = random_boxes(1000, 0.1f);
    for (Box& box : boxes) box.lo *= 1e30f, box.hi *= 1e30f;
    boxes.push_back({glm::vec3(-3e37f), glm::vec3(3e37f)});
    check_tree(build_bvh(boxes, 2), boxes);
}

TEST_CASE("long boxes across many short ones stay sound") {
    std::vector<Box> boxes = random_boxes(2000, 0.01f);
    for (int i = 0; i < 200; i++)
        boxes.push_back({glm::vec3(-1, -1, 0.01f * float(i) - 1), glm::vec3(1, 1, 0.01f * float(i) - 1)});
    check_tree(build_bvh(boxes, 2), boxes);
}

TEST_CASE("leaves hold no more than asked for") {
    const std::vector<Box> boxes = random_boxes(3000, 0.5f);
    check_tree(build_bvh(boxes, 2, {.max_leaf = 1}), boxes, 1);
}

TEST_CASE("the heuristic beats halving by count") {
    const TriangleSoup soup = interior(20000);
    std::vector<Box> boxes(soup.size());
    for (size_t i = 0; i < soup.size(); i++)
        for (int k = 0; k < 3; k++) boxes[i].grow(soup.vertices[3 * i + k]);
    const Bvh bvh = build_bvh(boxes, 2);
    check_tree(bvh, boxes);
    CHECK(bvh.statistics.sah_cost > 1);
    CHECK(bvh.statistics.sah_cost < 40);
}

TEST_CASE("quantised boxes hold the exact ones") {
    for (const float scale : {1e-6f, 1.0f, 1e6f}) {
        std::vector<Box> boxes = random_boxes(2000, 0.01f);
        for (Box& box : boxes) {
            box.lo = box.lo * scale + 10 * scale, box.hi = box.hi * scale + 10 * scale;
            box.lo.z = box.hi.z = 5 * scale;  // flat
        }
        const Bvh bvh = build_bvh(boxes, 1);
        std::vector<glm::uvec4> entries(7);
        const uint32_t header = encode_bvh(bvh, 1000, entries);
        REQUIRE(header == 7);
        const auto number = [](uint32_t word) { return double(std::bit_cast<float>(word)); };
        uint32_t mistakes = 0;
        for (size_t n = 0; n < bvh.nodes.size(); n++) {
            for (int side = 0; side < 2; side++) {
                const glm::uvec4 entry = entries[header + bvh_header_entries + 2 * n + side];
                const BvhReference child = bvh.nodes[n].child[side];
                mistakes +=
                    entry.w != (bvh_is_leaf(child) ? child + 1000 : header + bvh_header_entries + 2 * child);
                for (int axis = 0; axis < 3; axis++) {
                    const double lo = number(entries[header][axis]),
                                 cells = number(entries[header + 1][axis]);
                    const double down = lo + (entry[axis] & 0xFFFFu) / cells,
                                 up = lo + (entry[axis] >> 16) / cells;
                    const Box& box = bvh.nodes[n].bounds[side];
                    mistakes += !(down <= box.lo[axis] && box.hi[axis] <= up);
                    // Not coarser than two cells.
                    mistakes += !(up - down <= double(box.hi[axis]) - double(box.lo[axis]) + 2.01 / cells);
                }
            }
        }
        CHECK(mistakes == 0);
    }
}

TEST_CASE("leaves near the size of a grid cell count as coarse") {
    CHECK(coarse_share(build_bvh(random_boxes(2000, 0.05f), 1)) < 0.05);
    std::vector<Box> boxes = random_boxes(2000, 0.05f);
    boxes.push_back({glm::vec3(100000), glm::vec3(100001)});
    CHECK(coarse_share(build_bvh(boxes, 1)) > 0.9);
}
