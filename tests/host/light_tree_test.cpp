// The light hierarchy: every node encloses its lights, every trail leads to its light, no input breaks it.
#include "host/lights/light_tree.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi;

LightBounds point_light(glm::vec3 p, float power = 1) { return {p, power, p, -1, {0, 0, 1}, 0}; }
LightBounds infinite_light() { return {{1, 1, 1}, 1, {-1, -1, -1}, -1, {0, 0, 1}, 0}; }

std::vector<LightBounds> random_lights(uint32_t count, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<LightBounds> lights;
    for (uint32_t i = 0; i < count; ++i) {
        LightBounds b;
        const glm::vec3 p = 10.0f * glm::vec3(uniform(random), uniform(random), uniform(random));
        const glm::vec3 size = 0.1f * glm::abs(glm::vec3(uniform(random), uniform(random), uniform(random)));
        b.lo = p - size, b.hi = p + size;
        b.power = std::exp(3 * uniform(random));
        b.axis = glm::normalize(glm::vec3(uniform(random), uniform(random), uniform(random) + 1e-3f));
        b.cos_normals = i % 3 == 0 ? -1.0f : i % 3 == 1 ? 1.0f : uniform(random);
        b.cos_emission = i % 5 == 0 ? 0.9f : 0.0f;
        lights.push_back(b);
    }
    return lights;
}

double snorm(uint32_t packed) { return std::max(double(int16_t(packed & 0xFFFF)) / 32767, -1.0); }

glm::dvec3 octahedral_direction(uint32_t packed) {
    glm::dvec3 v(snorm(packed), snorm(packed >> 16), 0);
    v.z = 1 - std::abs(v.x) - std::abs(v.y);
    const double fold = std::max(-v.z, 0.0);
    v.x += v.x >= 0 ? -fold : fold;
    v.y += v.y >= 0 ? -fold : fold;
    return glm::normalize(v);
}

// Set k of a node holds the light.
bool encloses(const LightNode& n, int k, const LightBounds& b) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y,
                           corner & 4 ? b.hi.z : b.lo.z);
        if (glm::length(p - glm::dvec3(n.x[k], n.y[k], n.z[k])) > n.radius[k]) return false;
    }
    const glm::dvec3 axis = octahedral_direction(n.axes[k]), own(b.axis);
    const double between = std::atan2(glm::length(glm::cross(axis, own)), glm::dot(axis, own));
    const double normals = std::acos(snorm(n.cosines[k])), emission = std::acos(snorm(n.cosines[k] >> 16));
    return std::min(between + std::acos(double(b.cos_normals)), pi) <= normals &&
           std::acos(double(b.cos_emission)) <= emission;
}

constexpr uint32_t leaf_bit = 0x80000000u;

// Calls visit(node, k) for every set on the way to a light; returns the light that the trail leads to.
uint32_t follow(const LightTree& tree, uint32_t trail,
                const std::function<void(const LightNode&, int)>& visit) {
    uint32_t node = 0;
    while (true) {
        const LightNode& n = tree.nodes[node];
        const int k = int(trail & 3);
        trail >>= 2;
        visit(n, k);
        node = n.children[k];
        if (node & leaf_bit) return node & ~leaf_bit;
    }
}

void check_tree(const std::vector<LightBounds>& lights) {
    const LightTree tree = build_light_tree(lights);
    REQUIRE(tree.is_tree);
    REQUIRE(tree.depth <= 16);
    double total = 0;
    for (uint32_t i = tree.infinite_count; i < lights.size(); ++i) {
        total += peak_intensity(lights[i]);
        uint32_t depth = 0;
        const uint32_t reached = follow(tree, tree.trails[i], [&](const LightNode& n, int k) {
            ++depth;
            REQUIRE(encloses(n, k, lights[i]));
        });
        REQUIRE(reached == i);
        REQUIRE(depth <= tree.depth);
    }
    const glm::vec4 root = tree.nodes[0].intensity;
    CHECK(double(root.x) + root.y + root.z + root.w == doctest::Approx(total).epsilon(1e-5));
}

}  // namespace

TEST_CASE("light tree: no point chooses a light that forward rays alone bring") {
    LightBounds beam = point_light({1, 2, 3}, 100);
    beam.cos_normals = 1, beam.cos_emission = 2;  // unmet_rays() of shaders/interfaces/light_source.glsl
    CHECK(is_unmet(beam));
    CHECK(!is_unmet(point_light({1, 2, 3})));
    CHECK(peak_intensity(beam) == 0);
    const std::vector<LightBounds> lights = {beam, point_light({0, 0, 0})};
    CHECK(build_light_tree(lights).nodes[0].intensity[0] == 0);
}

TEST_CASE("light tree: every node encloses the positions, normals and emission of its lights") {
    check_tree(random_lights(17));
    check_tree(random_lights(5000));
}

TEST_CASE("light tree: lights at infinity come first and stay out of the tree") {
    std::vector<LightBounds> lights = random_lights(100);
    lights.insert(lights.begin(), 2, infinite_light());
    CHECK(build_light_tree(lights).infinite_count == 2);
    check_tree(lights);
}

TEST_CASE(
    "light tree: coincident lights, lights on a line and lights at growing distances stay within 16 levels") {
    check_tree(std::vector<LightBounds>(3000, point_light({1, 2, 3})));
    std::vector<LightBounds> line, growing;
    for (int i = 0; i < 3000; ++i) line.push_back(point_light({float(i), 0, 0}));
    for (int i = 0; i < 3000; ++i)
        growing.push_back(
            point_light({std::exp2(float(i % 120)), 1e-3f * float(i), 0}, std::exp2(float(i % 60))));
    check_tree(line);
    check_tree(growing);
}

TEST_CASE("light tree: lights without power do no harm") {
    std::vector<LightBounds> lights = random_lights(50);
    for (LightBounds& b : lights) b.power = 0;
    check_tree(lights);
}

TEST_CASE("light tree: a few lights are listed, in order") {
    const auto lights = random_lights(5);
    const LightTree list = build_light_tree(lights);
    CHECK(!list.is_tree);
    REQUIRE(list.nodes.size() == 2);
    for (uint32_t i = 0; i < 5; ++i) {
        CHECK(list.trails[i] == i);
        CHECK(list.nodes[i / 4].children[i % 4] == (leaf_bit | i));
        CHECK(encloses(list.nodes[i / 4], i % 4, lights[i]));
    }
    CHECK(list.nodes[1].children.y == 0xFFFFFFFFu);
    CHECK(list.nodes[1].intensity.y == 0.0f);
    CHECK(build_light_tree({}).nodes.empty());
    CHECK(build_light_tree(std::vector{infinite_light()}).infinite_count == 1);
}

TEST_CASE("light tree: the same lights give the same tree") {
    const auto lights = random_lights(2000);
    const LightTree a = build_light_tree(lights), b = build_light_tree(lights);
    CHECK(a.trails == b.trails);
    CHECK(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(LightNode)) == 0);
}

TEST_CASE("light tree: a light's peak intensity is its power over its pattern's solid angle") {
    LightBounds b = point_light({0, 0, 0}, 8);
    CHECK(peak_intensity(b) == doctest::Approx(8 / (4 * pi)));  // all around
    b.cos_normals = 1;
    CHECK(peak_intensity(b) == doctest::Approx(8 / pi));  // a flat surface: I cos
    b.cos_emission = float(std::cos(0.3));
    double measure = 0;
    for (int i = 0; i < 100000; ++i) {
        const double angle = 0.3 * (i + 0.5) / 100000;
        measure += 2 * pi * std::cos(angle) * std::sin(angle) * 0.3 / 100000;
    }
    CHECK(peak_intensity(b) == doctest::Approx(8 / measure).epsilon(1e-5));
}
