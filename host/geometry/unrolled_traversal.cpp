#include "host/geometry/unrolled_traversal.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/geometry/patches.h"

namespace etendue {
namespace {

using glm::dvec3;
using glm::dvec4;

// GLSL of a float constant, exactly.
std::string literal(double value) {
    std::string text = fmt::format("{:.9g}", static_cast<float>(value));
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return value < 0 ? "(" + text + ")" : text;
}

// Directions that rays are projected on, up to sign; the first three are the axes.
class Directions {
  public:
    // Index of a direction that `d` may be replaced by, a new one where there is none.
    uint32_t add(const dvec3& d, double tolerance) {
        const dvec3 unit = glm::normalize(d);
        uint32_t i = find(unit, tolerance);
        if (i == known_.size()) known_.push_back(unit), uses_.push_back(0);
        uses_[i]++;
        return i;
    }
    uint32_t find(const dvec3& d, double tolerance) const {
        const dvec3 unit = glm::normalize(d);
        for (uint32_t i = 0; i < known_.size(); i++)
            if (std::min(glm::length(known_[i] - unit), glm::length(known_[i] + unit)) < tolerance) return i;
        return static_cast<uint32_t>(known_.size());
    }
    uint32_t uses(uint32_t i) const { return uses_[i]; }
    const dvec3& direction(uint32_t i) const { return known_[i]; }
    static std::string origin(uint32_t i) {
        return i < 3 ? fmt::format("origin.{}", "xyz"[i]) : fmt::format("o{}", i);
    }
    static std::string along(uint32_t i) {
        return i < 3 ? fmt::format("direction.{}", "xyz"[i]) : fmt::format("d{}", i);
    }
    static std::string inverse(uint32_t i) {
        return i < 3 ? fmt::format("inverse.{}", "xyz"[i]) : fmt::format("i{}", i);
    }

    std::string projections(const std::vector<bool>& needs_projection,
                            const std::vector<bool>& needs_inverse) const {
        std::string text = "    vec3 inverse = 1.0 / direction;\n";
        for (uint32_t i = 3; i < known_.size(); i++) {
            const dvec3& w = known_[i];
            if (needs_projection[i])
                text += fmt::format(
                    "    float {} = dot(origin, vec3({}, {}, {}));\n    float {} = dot(direction, vec3({}, "
                    "{}, {}));\n",
                    origin(i), literal(w.x), literal(w.y), literal(w.z), along(i), literal(w.x), literal(w.y),
                    literal(w.z));
            if (needs_inverse[i]) text += fmt::format("    float {} = 1.0 / {};\n", inverse(i), along(i));
        }
        return text;
    }
    size_t size() const { return known_.size(); }

  private:
    std::vector<dvec3> known_{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
    std::vector<uint32_t> uses_{8, 8, 8};
};

// How far a direction may be from the one that stands for it, as sines: well inside the margins below.
constexpr double plane_tolerance = 2e-7, side_tolerance = 1e-6;

// By so much of the greatest coordinate patches with sides are widened, so that rays from anywhere find no
// crack; and sides must be so long that this is less than 1e-4 of them.
constexpr double margin_part = 2e-6, least_side = 1e4 * margin_part;

// Writes the tests. Each leaves `t` and whether it is met in `met`.
class Writer {
  public:
    Writer(const std::vector<Patch>& patches, double reach)
        : patches_(patches), margin_(margin_part * reach), reach_(reach) {
        for (const Patch& patch : patches_)
            if (patch.kind != Patch::Kind::sphere)
                directions_.add(glm::cross(patch.e1, patch.e2), plane_tolerance);
        for (const Patch& patch : patches_)
            if (patch.kind == Patch::Kind::parallelogram)
                for (const dvec3& d : dual(patch.e1, patch.e2)) directions_.add(d, side_tolerance);
        needs_projection_.resize(directions_.size());
        needs_inverse_.resize(directions_.size());
    }

    std::string test(const Patch& patch) {
        if (patch.kind == Patch::Kind::sphere) return sphere(patch);
        const uint32_t k = directions_.find(glm::cross(patch.e1, patch.e2), plane_tolerance);
        const dvec3 n = directions_.direction(k);
        needs_projection_[k] = needs_inverse_[k] = true;
        dvec3 middle = patch.corner;
        if (patch.kind == Patch::Kind::parallelogram) middle += 0.5 * (patch.e1 + patch.e2);
        if (patch.kind == Patch::Kind::triangle) middle += (patch.e1 + patch.e2) / 3.0;
        double level = glm::dot(n, middle);
        std::string apart;
        // On a plane across an axis the sign of the height is exact. Elsewhere an origin nearer than the
        // rounding of the height lies on the plane.
        const bool exact = k < 3 && patch.e1[int(k)] == 0 && patch.e2[int(k)] == 0;
        if (exact)
            level = patch.corner[int(k)];
        else
            apart = fmt::format(" && abs(height) > {}", literal(8e-7 * reach_));
        std::string text = fmt::format("        float height = {} - {};\n        t = height * {};\n",
                                       literal(level), Directions::origin(k), Directions::inverse(k));
        text += inside(patch, k);
        return text + fmt::format("        met = inside && t > 0.0 && t < best{};\n", apart);
    }

    std::string projections() const { return directions_.projections(needs_projection_, needs_inverse_); }

  private:
    std::string inside(const Patch& patch, uint32_t plane) {
        if (patch.kind == Patch::Kind::disk)
            return fmt::format(
                "        vec3 p = (origin - vec3({}, {}, {})) + t * direction;\n"
                "        bool inside = dot(p, p) <= {};\n",
                literal(patch.corner.x), literal(patch.corner.y), literal(patch.corner.z),
                literal(patch.radius * patch.radius));
        const auto gradients = dual(patch.e1, patch.e2);
        if (patch.kind == Patch::Kind::parallelogram) {
            const uint32_t i = directions_.find(gradients[0], side_tolerance),
                           j = directions_.find(gradients[1], side_tolerance);
            if (directions_.uses(i) > 2 && directions_.uses(j) > 2) {
                needs_projection_[i] = needs_projection_[j] = true;
                const dvec3 middle = patch.corner + 0.5 * (patch.e1 + patch.e2);
                const auto half = [&](const dvec3& w, const dvec3& e) {
                    return 0.5 * std::abs(glm::dot(w, e)) + margin_;
                };
                const dvec3 wi = directions_.direction(i), wj = directions_.direction(j);
                return fmt::format(
                    "        bool inside = all(lessThanEqual(abs(vec2({} + t * {}, {} + t * {}) - vec2({}, "
                    "{})), vec2({}, {})));\n",
                    Directions::origin(i), Directions::along(i), Directions::origin(j), Directions::along(j),
                    literal(glm::dot(wi, middle)), literal(glm::dot(wj, middle)), literal(half(wi, patch.e1)),
                    literal(half(wj, patch.e2)));
            }
        }
        // Seen along the axis that the plane faces most, the sides are affine in the other two coordinates.
        const dvec3 n = glm::abs(directions_.direction(plane));
        const int skip = n.x >= n.y && n.x >= n.z ? 0
                         : n.y >= n.z             ? 1
                                                  : 2,
                  x = skip == 0 ? 1 : 0, y = skip == 2 ? 1 : 2;
        const double det = patch.e1[x] * patch.e2[y] - patch.e1[y] * patch.e2[x];
        const double ax = patch.e2[y] / det, ay = -patch.e2[x] / det, bx = -patch.e1[y] / det,
                     by = patch.e1[x] / det;
        const double a0 = -(ax * patch.corner[x] + ay * patch.corner[y]),
                     b0 = -(bx * patch.corner[x] + by * patch.corner[y]);
        const double ma = margin_ * glm::length(gradients[0]), mb = margin_ * glm::length(gradients[1]);
        std::string text = fmt::format(
            "        vec2 p = origin.{0}{1} + t * direction.{0}{1};\n"
            "        float a = p.x * {2} + (p.y * {3} + {4}), b = p.x * {5} + (p.y * {6} + {7});\n",
            "xyz"[x], "xyz"[y], literal(ax), literal(ay), literal(a0), literal(bx), literal(by), literal(b0));
        if (patch.kind == Patch::Kind::parallelogram)
            text += fmt::format(
                "        bool inside = all(lessThanEqual(abs(vec2(a, b) - 0.5), vec2({}, {})));\n",
                literal(0.5 + ma), literal(0.5 + mb));
        else
            text +=
                fmt::format("        bool inside = a >= {} && b >= {} && a + b <= {};\n", literal(-ma),
                            literal(-mb), literal(1 + margin_ * glm::length(gradients[0] + gradients[1])));
        return text;
    }

    // As geometry/sphere.glsl.
    std::string sphere(const Patch& patch) {
        return fmt::format(
            "        vec3 f = origin - vec3({0}, {1}, {2});\n"
            "        float b = -dot(f, direction);\n"
            "        float nearest = length(f + (b * inverse_length2) * direction), distance = length(f);\n"
            "        float discriminant = ({3} - nearest) * ({3} + nearest);\n"
            "        float root = sqrt(length2 * max(discriminant, 0.0));\n"
            "        float q = b >= 0.0 ? b + root : b - root;\n"
            "        float t0 = (distance - {3}) * (distance + {3}) / q, t1 = q * inverse_length2;\n"
            "        float near = min(t0, t1), far = max(t0, t1);\n"
            "        t = near > 0.0 ? near : far;\n"
            "        met = discriminant >= 0.0 && t > 0.0 && t < best;\n",
            literal(patch.corner.x), literal(patch.corner.y), literal(patch.corner.z), literal(patch.radius));
    }

    const std::vector<Patch>& patches_;
    Directions directions_;
    std::vector<bool> needs_projection_, needs_inverse_;
    double margin_, reach_;  // m
};

// Entries of a patch in `nodes`: which piece, then primitive and rows of both.
constexpr uint32_t patch_entries = 7;
void append_entries(const Patch& patch, std::vector<glm::uvec4>& nodes) {
    const auto bits = [](const dvec4& v) {
        return glm::uvec4(std::bit_cast<uint32_t>(float(v.x)), std::bit_cast<uint32_t>(float(v.y)),
                          std::bit_cast<uint32_t>(float(v.z)), std::bit_cast<uint32_t>(float(v.w)));
    };
    nodes.push_back(bits(patch.divide));
    for (int side = 0; side < 2; side++) {
        const PatchPiece& piece = patch.pieces[patch.two ? side : 0];
        nodes.emplace_back(piece.primitive, 0, 0, 0);
        nodes.push_back(bits(piece.rows[0]));
        nodes.push_back(bits(piece.rows[1]));
    }
}

}  // namespace

UnrolledTraversal unroll_traversal(World& world, const SceneDescription& scene, uint32_t max_tests) {
    UnrolledTraversal result;
    if (world.world_primitives == 0 || world.world_primitives > 2 * max_tests) return result;
    const auto found = find_patches(world, scene);
    if (!found || found->size() > max_tests) return result;
    const std::vector<Patch>& patches = *found;

    const glm::vec3 far_corner = glm::max(glm::abs(world.bounds.lo), glm::abs(world.bounds.hi));
    const double reach = std::max({far_corner.x, far_corner.y, far_corner.z});
    for (const Patch& patch : patches)
        if (shortest_side(patch) < least_side * reach) return result;
    Writer writer(patches, reach);
    const auto first = static_cast<uint32_t>(world.nodes.size());
    std::string nearest, any;
    bool spheres = false;
    for (uint32_t i = 0; i < patches.size(); i++) {
        append_entries(patches[i], world.nodes);
        spheres = spheres || patches[i].kind == Patch::Kind::sphere;
        const std::string test = writer.test(patches[i]);
        nearest += fmt::format(
            "    {{\n{}        best = met ? t : best;\n        patch_entry = met ? {}u : patch_entry;\n    "
            "}}\n",
            test, first + i * patch_entries);
        any += fmt::format("    {{\n{}        occluded = occluded || met;\n    }}\n", test);
    }
    std::string shared = writer.projections();
    if (spheres)
        shared += "    float length2 = dot(direction, direction), inverse_length2 = 1.0 / length2;\n";
    shared += "    bool met;\n    float t;\n";
    result.glsl =
        "// Written by host/geometry/unrolled_traversal.cpp: every primitive of the scene, one test after "
        "the "
        "other.\n"
        "Hit find_hit(vec3 origin, vec3 direction, float t_max) {\n"
        "    float best = t_max;\n    uint patch_entry = NO_RECORD;\n" +
        shared + nearest +
        "    if (patch_entry == NO_RECORD) return Hit(t_max, vec2(0), NO_RECORD, NO_RECORD);\n"
        "    vec4 p = vec4(origin + best * direction, 1.0);\n"
        "    uint piece = patch_entry + (dot(uintBitsToFloat(nodes[patch_entry]), p) >= 0.0 ? 1u : 4u);\n"
        "    vec2 uv = vec2(dot(uintBitsToFloat(nodes[piece + 1u]), p), dot(uintBitsToFloat(nodes[piece "
        "+ 2u]), p));\n"
        "    return Hit(best, uv, nodes[piece].x, NO_RECORD);\n"
        "}\n\n"
        "bool find_occlusion(vec3 origin, vec3 direction, float t_max) {\n"
        "    float best = t_max;\n    bool occluded = false;\n" +
        shared + any +
        "    return occluded;\n"
        "}\n";
    result.primitives = world.world_primitives;
    result.tests = static_cast<uint32_t>(patches.size());
    return result;
}

}  // namespace etendue
