// Light vertices along rays against trying every pair on the host.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "tests/support/device_fixture.h"
#include "tests/support/vertex_map_probe.h"

using namespace etendue;

namespace {

// Radii of vertices: least + slope times the distance from a camera.
struct Radii {
    float least, slope;
    glm::vec3 camera;
    float at(const glm::vec3& p) const { return least + slope * glm::distance(p, camera); }
    std::string glsl() const {
        return fmt::format("{:.9e} + {:.9e} * distance(p, vec3({:.9e}, {:.9e}, {:.9e}))", least, slope,
                           camera.x, camera.y, camera.z);
    }
};

// -1: outside, 1: inside, 0: too near to the border for floats to tell.
int side(const glm::dvec3& origin, const glm::dvec3& end, const glm::dvec3& p, double radius) {
    const double length = glm::distance(origin, end);
    const glm::dvec3 direction = (end - origin) / length, d = p - origin;
    const double t = glm::dot(d, direction), aside = glm::length(d - t * direction);
    const double tolerance = 2e-6 * (length + glm::length(origin));
    if (t < -tolerance || t > length + tolerance || aside > radius + tolerance) return -1;
    return t > tolerance && t < length - tolerance && aside < radius - tolerance ? 1 : 0;
}

// How many vertices were found in all.
size_t check(const Radii& radii, const std::vector<glm::vec3>& rays, float spread = 1,
             const glm::vec3& centre = glm::vec3(0)) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<GridPoint> points, stored, ends;
    for (uint32_t i = 0; i < 20000; ++i) {
        const glm::vec3 p = centre + spread * glm::vec3(uniform(random), uniform(random), uniform(random));
        points.push_back({p, radii.at(p), i});
        stored.push_back({p, beam_cell_scale * radii.at(p), i});
    }
    for (const glm::vec3& p : rays) ends.push_back({p, radii.slope});
    VertexMapProbe probe(test_device(), uint32_t(points.size()));
    probe.store(stored, 3, uint32_t(stored.size()));
    const auto found = probe.along(ends, radii.glsl(), 4000);
    size_t total = 0, missed = 0, wrong = 0, twice = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        std::vector<uint32_t> times(points.size(), 0);
        for (const uint32_t key : found[i]) twice += ++times.at(key) > 1;
        for (const GridPoint& p : points) {
            const int where = side(rays[2 * i], rays[2 * i + 1], p.position, p.radius);
            missed += where == 1 && times[p.key] == 0;
            wrong += where == -1 && times[p.key] > 0;
        }
        total += found[i].size();
    }
    CHECK(missed == 0);
    CHECK(wrong == 0);
    CHECK(twice == 0);
    return total;
}

std::vector<glm::vec3> random_rays(size_t count, const glm::vec3& centre = glm::vec3(0), float spread = 1) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(-1.3f, 1.3f);
    std::vector<glm::vec3> ends(2 * count);
    for (glm::vec3& p : ends)
        p = centre + spread * glm::vec3(uniform(random), uniform(random), uniform(random));
    return ends;
}

}  // namespace

TEST_CASE("rays meet the vertices whose radius they reach, each once") {
    const glm::vec3 origin(0);
    SUBCASE("radii alike") { CHECK(check({0.03f, 0, origin}, random_rays(300)) > 2000); }
    SUBCASE("radii alike, a power of two of a cell") {
        CHECK(check({1 / (2.125f * 32), 0, origin}, random_rays(300)) > 500);
    }
    SUBCASE("radii of many levels around a camera in their midst") {
        CHECK(check({1e-5f, 0.04f, origin}, random_rays(300)) > 1000);
    }
    SUBCASE("radii of many levels, rays through the camera") {
        const uint32_t turns = test_device().description.max_loop_turns, wanted = 134000;  // of the ray with most vertices
        if (turns > 0 && turns < wanted) {
            MESSAGE("left out: the device ends loops after ", turns, " turns");
            return;
        }
        std::vector<glm::vec3> rays = random_rays(300);
        for (size_t i = 0; i < rays.size(); i += 2) rays[i] = -0.7f * rays[i + 1];
        CHECK(check({1e-5f, 0.04f, origin}, rays) > 1000);
    }
    SUBCASE("a camera outside, as pixels have it") {
        CHECK(check({0, 0.006f, {0.3f, 0.2f, 5}}, random_rays(300)) > 1000);
    }
    SUBCASE("along axes and faces of cells") {
        std::vector<glm::vec3> rays;
        for (int i = 0; i < 300; ++i) {
            glm::vec3 a(float(i % 10 - 5) / 8, float(i / 10 % 10 - 5) / 8, 0.25f), b = a;
            a[i % 3] = -1.1f, b[i % 3] = 1.2f;
            rays.insert(rays.end(), {i % 2 ? a : b, i % 2 ? b : a});
        }
        CHECK(check({0.03f, 0, origin}, rays) > 2000);
        CHECK(check({0.001f, 0.02f, origin}, rays) > 1000);
    }
    SUBCASE("short rays") {
        std::vector<glm::vec3> rays = random_rays(2000);
        for (size_t i = 0; i < rays.size(); i += 2) rays[i + 1] = rays[i] + 0.02f * (rays[i + 1] - rays[i]);
        CHECK(check({0.03f, 0.01f, origin}, rays) > 100);
    }
    SUBCASE("far from the origin") {
        const glm::vec3 far(1e4f, -1e4f, 1e4f);
        CHECK(check({2, 0, origin}, random_rays(300, far, 100), 100, far) > 1000);
    }
}
