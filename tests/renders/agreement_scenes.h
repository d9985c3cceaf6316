// What the scenes that set algorithms against each other are built of.
#pragma once
#include <cmath>
#include <numbers>

#include "host/image/png.h"
#include "tests/renders/sheets.h"
#include "tests/support/render_probe.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

// From the ceiling of a room (+y is up) downward.
inline Place hanging(double x, double y, double z) {
    constexpr double half_turn = 0.70710678118654752;
    return {{x, y, z}, {half_turn, 0, 0, half_turn}};
}

inline nlohmann::json metal(double alpha) {
    return {{"class", "conductor"}, {"alpha", alpha}, {"reflectance", {0.9, 0.8, 0.6}}};
}

// 4 m wide, around the origin, seen from its front wall.
inline void add_room(SceneBuilder& s) {
    add_box(s, {4, 4, 4}, s.lambertian({0.7, 0.5, 0.3}), true, at(0, 0, 0));
    s.perspective(1.2, at(0, 0, 1.95));
}

inline void add_lamp(SceneBuilder& s, double size) {
    const double l = 4 / (size * size);
    s.rectangle(size, size, s.black_emitter({l, 1.1 * l, 1.2 * l}), hanging(0, 1.95, 0));
}

// Fog around a mirror, under a small lamp, seen through a wave plate.
inline void add_foggy_room(SceneBuilder& s, const nlohmann::json& phase, const nlohmann::json& walls) {
    s.medium("fog", {{"scattering", 0.5}, {"phase", phase}});
    add_box(s, {4, 4, 4}, s.lambertian(walls), true, at(0, 0, 0));
    s.sphere(1.2, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "fog"}}), at(0, 0, -0.5));
    s.perspective(1.2, at(0, 0, 1.95));
    add_lamp(s, 0.5);
    s.rectangle(0.3, 0.3, s.surface(wave_plate(0.9, 1.1)), at(0, 0, 1.8));
    s.sphere(0.4, s.surface({{"class", "conductor"}, {"eta", 0.2}, {"k", 3.4}}), at(0.2, -0.2, -0.6));
}

// A sphere of segments * (rings - 1) * 2 facets, the vertex normals those of the sphere.
inline void add_sphere_mesh(SceneBuilder& s, float radius, uint32_t segments, uint32_t rings, int material,
                            const Place& place) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i <= rings; ++i)
        for (uint32_t k = 0; k <= segments; ++k) {
            const float theta = float(std::numbers::pi) * float(i) / float(rings);
            const float phi = 2 * float(std::numbers::pi) * float(k % segments) / float(segments);
            normals.push_back(
                {std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)});
            positions.push_back(radius * normals.back());
            uvs.push_back({float(k) / float(segments), float(i) / float(rings)});
        }
    for (uint32_t i = 0; i < rings; ++i)
        for (uint32_t k = 0; k < segments; ++k) {
            const uint32_t a = i * (segments + 1) + k, b = a + segments + 1;
            if (i > 0) indices.insert(indices.end(), {a, b, a + 1});
            if (i + 1 < rings) indices.insert(indices.end(), {a + 1, b, b + 1});
        }
    s.mesh(positions, indices, material, place, normals, uvs);
}

inline void add_coarse_sphere(SceneBuilder& s, float radius, int material, const Place& place) {
    add_sphere_mesh(s, radius, 8, 6, material, place);
}

// The bytes of the texture are those of `value` at its texels' centres; alpha stays 1.
template <class F>
int add_texture(SceneBuilder& s, const TemporaryFolder& folder, const std::string& name, uint32_t size,
                F value) {
    Image image;
    image.width = image.height = size;
    std::vector<float> pixels;
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            const glm::vec3 v = value((x + 0.5f) / float(size), (y + 0.5f) / float(size));
            for (int c = 0; c < 3; ++c)  // write_png encodes as sRGB
                pixels.push_back(v[c] <= 0.04045f ? v[c] / 12.92f : std::pow((v[c] + 0.055f) / 1.055f, 2.4f));
        }
    add_channels(image, {"R", "G", "B"}, pixels, 3);
    write_png(folder / (name + ".png"), image);
    s.document["images"].push_back({{"uri", name + ".png"}});
    s.document["textures"].push_back({{"source", s.document["images"].size() - 1}});
    return int(s.document["textures"].size()) - 1;
}

}  // namespace etendue
