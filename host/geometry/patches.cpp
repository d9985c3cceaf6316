#include "host/geometry/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace etendue {
namespace {

using glm::dvec3;
using glm::dvec4;

dvec4 affine(const dvec3& gradient, const dvec3& zero) { return {gradient, -glm::dot(gradient, zero)}; }

std::array<dvec3, 3> vertices(const PrimitiveRecord& p) { return {dvec3(p.v0), dvec3(p.v1), dvec3(p.v2)}; }

Patch triangle_patch(const World& world, uint32_t i) {
    const auto v = vertices(world.primitives[i]);
    Patch patch;
    patch.corner = v[0], patch.e1 = v[1] - v[0], patch.e2 = v[2] - v[0];
    const auto [a, b] = dual(patch.e1, patch.e2);
    patch.pieces[0] = {i, {affine(a, v[0]), affine(b, v[0])}};
    return patch;
}

// Two triangles that share an edge and make a parallelogram within rounding.
std::optional<Patch> merge(const World& world, const Patch& a, const Patch& b, double tolerance) {
    const auto va = vertices(world.primitives[a.pieces[0].primitive]);
    const auto vb = vertices(world.primitives[b.pieces[0].primitive]);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {  // the corners away from the shared edge
            const dvec3 p = va[(i + 1) % 3], q = va[(i + 2) % 3], s = vb[(j + 1) % 3], t = vb[(j + 2) % 3];
            if (!((p == s && q == t) || (p == t && q == s))) continue;
            if (glm::length(va[i] + vb[j] - p - q) > tolerance) continue;
            Patch patch;
            patch.kind = Patch::Kind::parallelogram;
            patch.corner = va[i], patch.e1 = p - va[i], patch.e2 = q - va[i];
            patch.pieces[0] = a.pieces[0], patch.pieces[1] = b.pieces[0];
            patch.two = true;
            const auto [u, v] = dual(patch.e1, patch.e2);
            patch.divide = -affine(u + v, patch.corner) + dvec4(0, 0, 0, 1);  // a + b <= 1: the first
            return patch;
        }
    }
    return {};
}

struct Similarity {
    dvec3 axis[3], origin;  // axes of equal length, orthogonal
    double scale;
};
dvec3 column(const TransformRecord& m, int i) { return dvec3(m.world_from_local[i]); }
std::optional<Similarity> similarity(const TransformRecord& m) {
    Similarity s{{column(m, 0), column(m, 1), column(m, 2)}, column(m, 3), glm::length(column(m, 0))};
    for (int i = 0; i < 3; i++) {
        if (std::abs(glm::length(s.axis[i]) - s.scale) > 1e-6 * s.scale) return {};
        if (std::abs(glm::dot(s.axis[i], s.axis[(i + 1) % 3])) > 1e-6 * s.scale * s.scale) return {};
    }
    return s;
}

// As stored in records: parameters pass through float.
double number(const nlohmann::json& value) { return double(value.get<float>()); }

std::optional<Patch> shape_patch(const World& world, const SceneDescription& scene, uint32_t i) {
    const auto transform = std::bit_cast<uint32_t>(world.primitives[i].v0.y);
    if (transform >= scene.shapes.size()) return {};
    const ObjectDescription& object = scene.shapes[transform].object;
    const TransformRecord& m = world.transforms[transform];
    Patch patch;
    patch.pieces[0].primitive = i;
    if (object.class_name == "rectangle") {
        const dvec3 x = column(m, 0), y = column(m, 1), origin = column(m, 3);
        const double width = number(object.parameters.at("size").at(0)),
                     height = number(object.parameters.at("size").at(1));
        patch.kind = Patch::Kind::parallelogram;
        patch.e1 = width * x, patch.e2 = height * y;
        patch.corner = origin - 0.5 * (patch.e1 + patch.e2);
        const auto [a, b] = dual(x, y);
        patch.pieces[0].rows[0] = affine(a, origin), patch.pieces[0].rows[1] = affine(b, origin);
        return patch;
    }
    const auto s = similarity(m);
    if (!s || (object.class_name != "sphere" && object.class_name != "disk")) return {};
    patch.radius = number(object.parameters.at("radius")) * s->scale;
    patch.corner = s->origin;
    patch.kind = Patch::Kind::sphere;
    if (object.class_name == "disk") {
        patch.kind = Patch::Kind::disk;
        patch.e1 = s->axis[0], patch.e2 = s->axis[1];
        const auto [a, b] = dual(s->axis[0], s->axis[1]);
        patch.pieces[0].rows[0] = affine(a, s->origin), patch.pieces[0].rows[1] = affine(b, s->origin);
    }
    return patch;
}

}  // namespace

// Gradients of the coordinates a, b in p = a e1 + b e2 within the plane.
std::array<dvec3, 2> dual(const dvec3& e1, const dvec3& e2) {
    const dvec3 n = glm::cross(e1, e2);
    const double nn = glm::dot(n, n);
    return {glm::cross(e2, n) / nn, glm::cross(n, e1) / nn};
}

double shortest_side(const Patch& patch) {
    const bool has_sides = patch.kind == Patch::Kind::parallelogram || patch.kind == Patch::Kind::triangle;
    return has_sides ? std::min(glm::length(patch.e1), glm::length(patch.e2))
                     : std::numeric_limits<double>::infinity();
}

std::optional<std::vector<Patch>> find_patches(const World& world, const SceneDescription& scene) {
    std::vector<Patch> triangles, patches;
    double size = 0;
    for (uint32_t i = 0; i < world.world_primitives; i++) {
        const PrimitiveRecord& p = world.primitives[i];
        if (primitive_kind(p) == PrimitiveKind::triangle) {
            const Patch patch = triangle_patch(world, i);
            if (!(glm::length(glm::cross(patch.e1, patch.e2)) >
                  1e-9 * glm::length(patch.e1) * glm::length(patch.e2)))
                return {};  // slivers are for the watertight test
            triangles.push_back(patch);
            size = std::max({size, glm::length(patch.e1), glm::length(patch.e2)});
            continue;
        }
        const auto patch =
            primitive_kind(p) == PrimitiveKind::shape ? shape_patch(world, scene, i) : std::nullopt;
        if (!patch) return {};
        patches.push_back(*patch);
    }
    std::vector<char> done(triangles.size());
    for (size_t i = 0; i < triangles.size(); i++) {
        if (done[i]) continue;
        std::optional<Patch> merged;
        for (size_t j = i + 1; j < triangles.size() && !merged; j++)
            if (!done[j] && (merged = merge(world, triangles[i], triangles[j], 2e-7 * size))) done[j] = 1;
        patches.push_back(merged ? *merged : triangles[i]);
    }
    return patches;
}

}  // namespace etendue
