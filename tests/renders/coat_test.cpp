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

TEST_CASE("a coat with steep normals of its own over what loses nothing is as bright as the white sky") {
    // Seen obliquely: a coat that leans away reflects below the surface, of one that leans to the viewer a
    // mirror below shows what the coat hides.
    constexpr double tilt = 20 * degree, view = 65 * degree;
    const TemporaryFolder folder;
    SceneBuilder s;
    s.document["extensionsUsed"].push_back("KHR_materials_clearcoat");
    s.document["extensionsUsed"].push_back("KHR_materials_specular");
    const struct {
        std::string name;
        double base, metallic, coat_roughness;
    } sheets[] = {{"mirror", 1, 1, 0}, {"paint", 1, 0, 0}, {"black", 0, 0, 0}, {"black, rough", 0, 0, 0.5}};
    const std::string leans[] = {"away", "to the viewer"};
    for (int lean = 0; lean < 2; ++lean) {
        const float x = float(std::sin(tilt) * (lean == 0 ? -1 : 1)), z = float(std::cos(tilt));
        const int map = normal_map(s, folder, leans[lean], {x, 0, z});
        for (int i = 0; i < 4; ++i) {
            const double c = sheets[i].base;
            const json coat = {{"clearcoatFactor", 1},
                               {"clearcoatRoughnessFactor", sheets[i].coat_roughness},
                               {"clearcoatNormalTexture", {{"index", map}}}};
            s.document["materials"].push_back(
                {{"pbrMetallicRoughness",
                  {{"baseColorFactor", {c, c, c, 1}},
                   {"metallicFactor", sheets[i].metallic},
                   {"roughnessFactor", sheets[i].metallic == 1 ? 0 : 0.5}}},
                 {"extensions",
                  {{"KHR_materials_clearcoat", coat}, {"KHR_materials_specular", {{"specularFactor", 0}}}}}});
            add_sheet(s, 0.9f, int(s.document["materials"].size()) - 1, at(0, 4.0 * lean + i, 0));
        }
    }
    s.environment({1, 1, 1});
    s.orthographic(
        4, {{5 * std::sin(view), 3.5, 5 * std::cos(view)}, {0, std::sin(view / 2), 0, std::cos(view / 2)}});
    Scene scene = compile_test_scene(s.import(folder / "scene.gltf"));
    double rough[2] = {};
    for (Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        CAPTURE(algorithm_name(algorithm));
        // A forward path in a thousand meets what is seen.
        const Estimates e =
            render_estimates(scene, {.width = 16,
                                     .height = 128,
                                     .passes = 64,
                                     .seeds = 4,
                                     .algorithm = algorithm,
                                     .forward_paths = algorithm == Algorithm::forward ? 40.0 : 1.0});
        for (uint32_t row = 0; row < 8; ++row) {
            const int lean = int(row / 4), i = int(row % 4);
            const WindowMean m = window_mean(e, {6, 116 - 16 * row, 4, 8});
            INFO(sheets[i].name, ", leaning ", leans[lean], ": ", m.mean, " +- ", m.standard_error);
            const double schlick =
                0.04 + 0.96 * std::pow(1 - std::cos(lean == 0 ? view + tilt : view - tilt), 5);
            double expected = sheets[i].base == 1 ? 1 : schlick;
            if (sheets[i].coat_roughness > 0) {
                if (algorithm == Algorithm::backward) rough[lean] = m.mean;
                expected = rough[lean];
            }
            CHECK(std::abs(m.mean - expected) < 0.005 * expected + 4 * m.standard_error);
            // Forward rays that graze the surface and meet a rough coat are rare and bright.
            CHECK(m.standard_error < (algorithm == Algorithm::forward ? 0.2 : 0.02) * expected);
        }
    }
    CHECK(rough[0] > rough[1]);
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
