#include "host/lights/light_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

namespace etendue {
namespace {

constexpr uint32_t leaf_bit = 0x80000000u;
constexpr uint32_t max_depth = 16;  // two bits a level in a trail
constexpr double pi = std::numbers::pi;

struct Cone {
    glm::dvec3 axis{0, 0, 1};
    double angle = -1;  // rad; -1 = empty
};

glm::dvec3 rotate_about(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * (glm::dot(axis, v) * (1 - std::cos(angle)));
}

// The smallest cone around two cones (Conty Estévez & Kulla 2018, algorithm 1).
Cone unite(Cone a, Cone b) {
    if (b.angle > a.angle) std::swap(a, b);
    if (b.angle < 0) return a;
    const double between = std::atan2(glm::length(glm::cross(a.axis, b.axis)), glm::dot(a.axis, b.axis));
    if (std::min(between + b.angle, pi) <= a.angle) return a;
    const double angle = 0.5 * (a.angle + between + b.angle);
    const glm::dvec3 turn = glm::cross(a.axis, b.axis);
    if (angle >= pi || glm::length(turn) < 1e-12) return {a.axis, pi};
    return {glm::normalize(rotate_about(a.axis, glm::normalize(turn), angle - a.angle)), angle};
}

// Integral over directions of cos(max(0, angle to the axis - normals)), up to normals + emission: the paper's
// M_Omega.
double orientation_measure(double normals, double emission) {
    const double end = std::min(normals + emission, pi);
    return 2 * pi * (1 - std::cos(normals)) + pi / 2 *
                                                  (2 * end * std::sin(normals) - std::cos(normals - 2 * end) -
                                                   2 * normals * std::sin(normals) + std::cos(normals));
}

double safe_acos(double c) { return std::acos(std::clamp(c, -1.0, 1.0)); }

struct Item {
    LightBounds bounds;
    uint32_t light;
    float intensity;
    glm::vec3 center() const { return 0.5f * bounds.lo + 0.5f * bounds.hi; }
};

// What the cost of a split needs of a set of lights. The spread of directions is judged by their vector sum.
struct SplitSet {
    glm::vec3 lo{std::numeric_limits<float>::max()}, hi{std::numeric_limits<float>::lowest()};
    glm::dvec3 directions{0};
    double power = 0;
    float cos_emission = 1;
    uint32_t count = 0;

    void add(const Item& item) {
        lo = glm::min(lo, item.bounds.lo), hi = glm::max(hi, item.bounds.hi);
        directions += glm::dvec3(item.bounds.axis) * (0.5 + 0.5 * item.bounds.cos_normals);
        power += item.bounds.power;
        cos_emission = std::min(cos_emission, item.bounds.cos_emission);
        ++count;
    }
    void add(const SplitSet& other) {
        lo = glm::min(lo, other.lo), hi = glm::max(hi, other.hi);
        directions += other.directions;
        power += other.power;
        cos_emission = std::min(cos_emission, other.cos_emission);
        count += other.count;
    }
    // Directions spread evenly over a cap of half angle n have a mean of length (1 + cos n) / 2.
    double cost() const {
        if (count == 0) return 0;
        const double normals = safe_acos(2 * glm::length(directions) / count - 1);
        const glm::dvec3 extent = glm::dvec3(hi) - glm::dvec3(lo);
        return power * orientation_measure(normals, safe_acos(cos_emission)) * glm::dot(extent, extent);
    }
};

uint32_t pack_octahedral(const glm::dvec3& v) {
    glm::dvec2 p = glm::dvec2(v.x, v.y) / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
    if (v.z < 0)
        p = {(1 - std::abs(p.y)) * (p.x >= 0 ? 1.0 : -1.0), (1 - std::abs(p.x)) * (p.y >= 0 ? 1.0 : -1.0)};
    const auto snorm = [](double x) { return uint32_t(uint16_t(int16_t(std::lround(x * 32767)))); };
    return snorm(p.x) | snorm(p.y) << 16;
}

// Rounded down to 16 bits, with a margin above the rounding of the axis and of the shader's arithmetic.
uint32_t pack_cosine(double angle) {
    const double c = std::cos(std::min(angle + 1e-4, pi));
    return uint16_t(int16_t(std::clamp(std::floor(c * 32767 - 1), -32767.0, 32767.0)));
}

struct Builder {
    std::span<Item> items;
    LightTree tree;

    struct Subtree {
        glm::vec3 lo, hi;
        double intensity;
        Cone cone;
        double emission;  // rad
        uint32_t child;
    };

    static void store(LightNode& node, int k, const Subtree& s) {
        const glm::dvec3 lo(s.lo), hi(s.hi);
        const glm::vec3 center(0.5 * (lo + hi));
        const glm::dvec3 corner =
            glm::max(glm::abs(hi - glm::dvec3(center)), glm::abs(lo - glm::dvec3(center)));
        node.x[k] = center.x, node.y[k] = center.y, node.z[k] = center.z;
        node.radius[k] = float(glm::length(corner) * (1 + 1e-6));
        node.intensity[k] = float(s.intensity);
        node.axes[k] = pack_octahedral(s.cone.axis);
        node.cosines[k] = pack_cosine(s.cone.angle) | pack_cosine(s.emission) << 16;
        node.children[k] = s.child;
    }

    static Subtree leaf(const Item& item) {
        const LightBounds& b = item.bounds;
        return {b.lo,
                b.hi,
                item.intensity,
                Cone{glm::dvec3(b.axis), safe_acos(b.cos_normals)},
                safe_acos(b.cos_emission),
                leaf_bit | item.light};
    }

    // Chooses where to cut items [first, last) in two and orders them accordingly.
    size_t split(size_t first, size_t last, bool must_halve) {
        const size_t count = last - first;
        glm::vec3 lo(std::numeric_limits<float>::max()), hi(std::numeric_limits<float>::lowest());
        for (size_t i = first; i < last; ++i) {
            const glm::vec3 c = items[i].center();
            lo = glm::min(lo, c), hi = glm::max(hi, c);
        }
        const glm::dvec3 extent = glm::dvec3(hi) - glm::dvec3(lo);
        const double longest = std::max({extent.x, extent.y, extent.z});

        constexpr int bin_count = 16;
        const auto bin_of = [&](const Item& item, int axis) {
            const double t = (double(item.center()[axis]) - lo[axis]) / extent[axis];
            return std::clamp(int(t * bin_count), 0, bin_count - 1);
        };
        double best = std::numeric_limits<double>::infinity();
        int best_axis = -1, best_bin = 0;
        for (int axis = 0; axis < 3 && !must_halve; ++axis) {
            if (!(extent[axis] > 0)) continue;
            std::array<SplitSet, bin_count> bins, below;
            for (size_t i = first; i < last; ++i) bins[bin_of(items[i], axis)].add(items[i]);
            below[0] = bins[0];
            for (int b = 1; b < bin_count; ++b) below[b] = below[b - 1], below[b].add(bins[b]);
            SplitSet above;
            for (int b = bin_count - 1; b > 0; --b) {
                above.add(bins[b]);
                if (above.count == 0 || below[b - 1].count == 0) continue;
                const double cost = (below[b - 1].cost() + above.cost()) * (longest / extent[axis]);
                if (cost < best) best = cost, best_axis = axis, best_bin = b;
            }
        }
        if (best_axis >= 0) {
            const auto middle =
                std::stable_partition(items.begin() + first, items.begin() + last,
                                      [&](const Item& item) { return bin_of(item, best_axis) < best_bin; });
            return size_t(middle - items.begin());
        }
        const int axis = extent.x >= longest ? 0 : extent.y >= longest ? 1 : 2;
        std::stable_sort(items.begin() + first, items.begin() + last,
                         [&](const Item& a, const Item& b) { return a.center()[axis] < b.center()[axis]; });
        return first + count / 2;
    }

    // How much is to be gained by splitting a range: the spread of its power in space.
    double split_gain(size_t first, size_t last) const {
        if (last - first == 1) return -1;
        SplitSet set;
        for (size_t i = first; i < last; ++i) set.add(items[i]);
        const glm::dvec3 extent = glm::dvec3(set.hi) - glm::dvec3(set.lo);
        return set.power * glm::dot(extent, extent);
    }

    Subtree build(size_t first, size_t last, uint32_t depth, uint32_t trail) {
        if (last - first == 1) {
            tree.trails[items[first].light] = trail;
            return leaf(items[first]);
        }
        const uint32_t index = uint32_t(tree.nodes.size());
        tree.nodes.emplace_back();
        tree.depth = std::max(tree.depth, depth + 1);

        // Four sets, by splitting one after the other. Where few levels are left, into quarters: level d must
        // not be given more than 4^(16 - d) lights.
        const bool must_halve = uint32_t(std::bit_width(last - first - 1)) > 2 * (max_depth - depth - 1);
        std::vector<size_t> cuts = {first, last};
        std::vector<double> gains = {split_gain(first, last)};
        while (cuts.size() < 5) {
            size_t best = 0;
            for (size_t k = 1; k < gains.size(); ++k) {
                const bool larger = cuts[k + 1] - cuts[k] > cuts[best + 1] - cuts[best];
                if (must_halve ? larger : gains[k] > gains[best]) best = k;
            }
            if (cuts[best + 1] - cuts[best] < 2) break;
            const size_t middle = split(cuts[best], cuts[best + 1], must_halve);
            cuts.insert(cuts.begin() + best + 1, middle);
            gains[best] = split_gain(cuts[best], middle);
            gains.insert(gains.begin() + best + 1, split_gain(middle, cuts[best + 2]));
        }
        Subtree whole;
        for (size_t k = 0; k + 1 < cuts.size(); ++k) {
            const Subtree part = build(cuts[k], cuts[k + 1], depth + 1, trail | uint32_t(k) << (2 * depth));
            store(tree.nodes[index], int(k), part);
            if (k == 0)
                whole = part;
            else
                whole = {glm::min(whole.lo, part.lo),
                         glm::max(whole.hi, part.hi),
                         whole.intensity + part.intensity,
                         unite(whole.cone, part.cone),
                         std::max(whole.emission, part.emission),
                         index};
        }
        whole.child = index;
        return whole;
    }
};

}  // namespace

bool is_at_infinity(const LightBounds& light) { return light.lo.x > light.hi.x; }
bool is_unmet(const LightBounds& light) { return light.cos_emission > 1; }

float peak_intensity(const LightBounds& light) {
    if (is_unmet(light)) return 0;
    const double measure = orientation_measure(safe_acos(light.cos_normals), safe_acos(light.cos_emission));
    return float(light.power / std::max(measure, 1e-12));
}

LightTree build_light_tree(std::span<const LightBounds> lights, uint32_t max_listed) {
    std::vector<Item> items;
    Builder builder;
    builder.tree.trails.resize(lights.size());
    for (uint32_t i = 0; i < lights.size(); ++i) {
        if (is_at_infinity(lights[i]))
            ++builder.tree.infinite_count;
        else
            items.push_back({lights[i], i, peak_intensity(lights[i])});
    }
    builder.items = items;
    if (items.size() > max_listed) {
        builder.tree.is_tree = true;
        builder.tree.nodes.reserve(items.size() / 2);
        builder.build(0, items.size(), 0, 0);
        return std::move(builder.tree);
    }
    builder.tree.nodes.resize((items.size() + 3) / 4);
    for (size_t i = 0; i < items.size(); ++i) {
        Builder::store(builder.tree.nodes[i / 4], int(i % 4), Builder::leaf(items[i]));
        builder.tree.trails[items[i].light] = uint32_t(i);
    }
    return std::move(builder.tree);
}

}  // namespace etendue
