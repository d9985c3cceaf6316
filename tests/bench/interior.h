// A procedural interior of any number of triangles: a room with tessellated, displaced objects of very
// different sizes, as the benchmarks of traversal and hierarchy building use it.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace etendue {

struct TriangleSoup {
    std::vector<glm::vec3> vertices;  // three a triangle, m
    size_t size() const { return vertices.size() / 3; }
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        vertices.insert(vertices.end(), {a, b, c});
    }
};

// A surface over [0,1]² in n by n quads.
template <class Surface>
void tessellate(TriangleSoup& soup, int n, const Surface& surface) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const float u0 = float(i) / n, u1 = float(i + 1) / n, v0 = float(j) / n, v1 = float(j + 1) / n;
            const glm::vec3 a = surface(u0, v0), b = surface(u1, v0), c = surface(u1, v1),
                            d = surface(u0, v1);
            soup.add(a, b, c);
            soup.add(a, c, d);
        }
    }
}

// A room of 8 x 3 x 6 m: walls, a wavy carpet, bumpy spheres, vases and a curtain; about `triangles`
// triangles.
inline TriangleSoup interior(size_t triangles) {
    TriangleSoup soup;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    const glm::vec3 room(8, 3, 6);
    const auto wall = [&](glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
        tessellate(soup, 4, [&](float u, float v) { return corner + a * u + b * v; });
    };
    wall({0, 0, 0}, {room.x, 0, 0}, {0, room.y, 0});
    wall({0, 0, room.z}, {0, room.y, 0}, {room.x, 0, 0});
    wall({0, 0, 0}, {0, room.y, 0}, {0, 0, room.z});
    wall({room.x, 0, 0}, {0, 0, room.z}, {0, room.y, 0});
    wall({0, 0, 0}, {0, 0, room.z}, {room.x, 0, 0});
    wall({0, room.y, 0}, {room.x, 0, 0}, {0, 0, room.z});

    const int objects = 40;
    const int n = std::max(2, int(std::sqrt(double(triangles) / 2 / (objects + 8))));
    constexpr float pi = 3.14159265f;
    tessellate(soup, 2 * n, [&](float u, float v) {  // carpet
        return glm::vec3(1 + 6 * u, 0.02f + 0.015f * std::sin(90 * u) * std::sin(70 * v), 1 + 4 * v);
    });
    tessellate(soup, 2 * n, [&](float u, float v) {  // curtain
        return glm::vec3(0.2f + 0.1f * std::sin(60 * u), 0.1f + 2.8f * v, 0.5f + 5 * u);
    });
    for (int k = 0; k < objects; k++) {
        const float radius = 0.08f + 0.35f * uniform(random) * uniform(random);
        const glm::vec3 center(0.6f + 6.8f * uniform(random),
                               radius + 0.05f + 1.5f * uniform(random) * (k % 3),
                               0.6f + 4.8f * uniform(random));
        const float bumps = 3 + 20 * uniform(random), height = 0.25f * uniform(random);
        const bool vase = k % 2;
        tessellate(soup, n, [&](float u, float v) {
            const float phi = 2 * pi * u, theta = pi * v;
            float r = radius * (1 + height * std::sin(bumps * phi) * std::sin(bumps * theta));
            if (vase) r *= 0.6f + 0.4f * std::cos(4 * theta);
            return center + r * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                          std::sin(theta) * std::sin(phi));
        });
    }
    return soup;
}

}  // namespace etendue
