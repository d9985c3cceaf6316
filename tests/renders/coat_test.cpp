// Coats with normals of their own (KHR_materials_clearcoat): where they mirror, and that forward rays say the
// same.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double degree = std::numbers::pi / 180;

int normal_map(SceneBuilder& s, const TemporaryFolder& folder, const std::string& name, const glm::vec3& n) {
    return add_texture(s, folder, name, 4, [&](float, float) { return 0.5f * n + 0.5f; });
}

void add_sheet(SceneBuilder& s, float size, int material, const Place& place) {
    const float h = size / 2;
    s.mesh({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, {0, 1, 2, 0, 2, 3}, material, place,
           std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
}

}  // namespace

TEST_CASE("a coat mirrors about its own normals, whatever bends those below") {
    // Seen from above, a black sheet shows by its coat alone what lies at twice the tilt of the coat's
    // normal.
    constexpr double tilt = 15 * degree, f = 0.04;  // Schlick: 0.04 + 0.96 (1 - cos 15 degrees)^5
    const TemporaryFolder folder;
    for (const bool has_map : {true, false}) {
        CAPTURE(has_map);
        SceneBuilder s;
        s.document["extensionsUsed"].push_back("KHR_materials_clearcoat");
        s.document["extensionsUsed"].push_back("KHR_materials_specular");
        json coat = {{"clearcoatFactor", 1}};
        if (has_map)
            coat["clearcoatNormalTexture"] = {
                {"index",
                 normal_map(s, folder, "tilted", {float(std::sin(tilt)), 0, float(std::cos(tilt))})}};
        json more = {
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
            {"normalTexture", {{"index", normal_map(s, folder, "bumps", {-0.5f, 0.3f, 0.8f})}}},
            {"extensions",
             {{"KHR_materials_clearcoat", coat}, {"KHR_materials_specular", {{"specularFactor", 0}}}}}};
        s.document["materials"].push_back(more);
        add_sheet(s, 1, int(s.document["materials"].size()) - 1, at(0, 0, 0));
        // A small lamp where the coat's mirror image of the camera's direction lies, and none elsewhere.
        const double angle = has_map ? 2 * tilt : 0;
        s.shape({{"class", "disk"}, {"radius", 0.2}}, s.black_emitter(7),
                {{2 * std::sin(angle), 0, 2 * std::cos(angle)},
                 {0, std::cos(angle / 2), 0, -std::sin(angle / 2)}});
        s.orthographic(0.02, at(0, 0, 1));
        RenderPlan plan;
        plan.width = plan.height = 4, plan.passes = 256, plan.seeds = 4;
        const WindowMean m = window_mean(render_estimates(s.import(folder / "scene.gltf"), plan));
        CAPTURE(m.mean);
        CHECK(m.mean == doctest::Approx(7 * f).epsilon(0.01));
    }
}

TEST_CASE("algorithms agree: coats with normals of their own over bumps") {
    const TemporaryFolder folder;
    SceneBuilder s;
    s.document["extensionsUsed"].push_back("KHR_materials_clearcoat");
    add_room(s);
    add_lamp(s, 1.5);
    const auto waves = [&](const char* name, float kx, float ky) {
        return add_texture(s, folder, name, 16, [&](float u, float v) {
            return 0.5f * glm::normalize(glm::vec3(0.3f * std::sin(kx * u), 0.3f * std::cos(ky * v), 1)) +
                   0.5f;
        });
    };
    const int below = waves("below", 19, 13), above = waves("above", 7, 11);
    const auto coated = [&](double roughness, bool has_map) {
        json coat = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", roughness}};
        if (has_map) coat["clearcoatNormalTexture"] = {{"index", above}};
        s.document["materials"].push_back(
            {{"pbrMetallicRoughness",
              {{"baseColorFactor", {0.3, 0.5, 0.8, 1}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.5}}},
             {"normalTexture", {{"index", below}}},
             {"extensions", {{"KHR_materials_clearcoat", coat}}}});
        return int(s.document["materials"].size()) - 1;
    };
    add_coarse_sphere(s, 0.6f, coated(0.4, true), at(-1.1, -1.2, 0.3));
    add_coarse_sphere(s, 0.6f, coated(0, true), at(0.2, -1.2, -0.6));
    add_coarse_sphere(s, 0.6f, coated(0.4, false), at(1.2, -1.2, 0.3));
    Comparison c;
    c.backward = 128, c.forward = 64, c.bidirectional = 24;
    c.largest_error = 0.008;
    check_against_backward(s, c, folder / "scene.gltf");
}
