// Forward, backward and bidirectional rays give the same image: scenes with something of everything that
// could set them apart.
#include <doctest/doctest.h>

#include "host/image/exr.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

// Cells of 2 m in a row with black walls between them: on a diffuse floor a rough metal sphere, seen from
// above by parallel rays that start below the cells' lights.
struct Row {
    SceneBuilder scene;
    uint32_t cells = 0;
    double x = 1;  // middle of the cell being filled
    bool walls = true;
    void next(double alpha = 0.3) {
        x = 2 * cells + 1;
        scene.rectangle(2, 2, scene.lambertian({0.6, 0.5, 0.4}), at(x, 0, 0));
        scene.sphere(0.4, scene.surface(metal(alpha)), at(x + 0.3, 0.2, 0.4));
        if (cells > 0 && walls)
            scene.rectangle(3, 3, scene.surface({{"class", "absorber"}}), facing_x(2 * cells, 0, 1.4));
        ++cells;
    }
    void finish(Comparison& c) {
        scene.orthographic(1, at(cells, 0, 1.5));
        c.height = 16, c.width = 16 * cells;
    }
};

}  // namespace

TEST_CASE("algorithms agree: a Cornell box") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1);
    add_box(s, {1, 2, 1}, s.lambertian(0.6), false, {{-0.8, -1, -0.8}, {0, 0.3, 0, 0.954}});
    add_box(s, {1, 1, 1}, s.lambertian(0.6), false, {{0.8, -1.5, 0.2}, {0, -0.2, 0, 0.98}});
    check_against_backward(s);
}

TEST_CASE("algorithms agree: finite lights of every class over a diffuse and a glossy surface") {
    const TemporaryFolder folder;
    Row row;
    SceneBuilder& s = row.scene;
    row.next();
    s.light({{"type", "point"}, {"intensity", 3}, {"color", {1, 0.8, 0.6}}}, at(row.x - 0.2, 0, 2));
    row.next();
    s.light(
        {{"type", "spot"}, {"intensity", 8}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}},
        at(row.x, 0.1, 2.2));
    row.next();
    const std::vector<glm::vec3> corners = {{-0.5f, -0.5f, 0}, {0.7f, -0.3f, 0.2f}, {0, 0.8f, 0.1f}};
    s.mesh(corners, {0, 2, 1}, s.black_emitter({3, 4, 5}), at(row.x, 0, 2));
    row.next();
    s.rectangle(1, 0.5, s.black_emitter({5, 4, 3}), facing_down(row.x, 0, 2));
    row.next();
    s.sphere(0.3, s.black_emitter(5), at(row.x, 0, 2));
    row.next();
    s.shape({{"class", "disk"}, {"radius", 0.5}}, s.black_emitter(6), facing_down(row.x, 0.2, 1.9));
    row.next();
    s.shape({{"class", "cylinder"}, {"radius", 0.1}, {"height", 1.5}}, s.black_emitter(5),
            facing_x(row.x, 0, 2));
    row.next();  // from its back
    const int both = s.black_emitter(4);
    s.document["materials"][size_t(both)]["doubleSided"] = true;
    s.rectangle(0.8, 0.8, both, at(row.x, 0, 2));
    row.next();
    const int texture = add_texture(s, folder, "stripes", 8, [](float u, float v) {
        return glm::vec3(u < 0.5f ? 1.0f : 0.1f, v, 0.5f + 0.5f * u * v);
    });
    s.rectangle(
        1, 1,
        s.material({{"surface", {{"class", "absorber"}}}},
                   {{"emissiveFactor", {1, 1, 1}},
                    {"emissiveTexture", {{"index", texture}}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}}),
        facing_down(row.x, 0, 2));
    s.document["extensionsUsed"].push_back("KHR_materials_emissive_strength");
    Comparison c;
    row.finish(c);
    check_against_backward(s, c, folder / "scene.gltf");
}

TEST_CASE("algorithms agree: a directional light and a constant environment") {
    Row row;
    row.walls = false;
    row.next();
    row.next(0.1);
    row.scene.light({{"type", "directional"}, {"intensity", 2}, {"color", {1, 0.9, 0.7}}},
                    {{0, 0, 0}, {0.2, 0.1, 0, 0.9747}});
    row.scene.environment({0.2, 0.3, 0.4});
    Comparison c;
    row.finish(c);
    check_against_backward(row.scene, c);
}

TEST_CASE("algorithms agree: an image environment" * doctest::test_suite("long")) {
    const TemporaryFolder folder;
    Image sky;
    sky.width = 16, sky.height = 8;
    std::vector<float> pixels;
    for (int i = 0; i < 16 * 8 * 3; ++i) pixels.push_back(0.2f + float(i * 7919 % 101) / 100.0f);
    pixels[3 * 40] = pixels[3 * 40 + 1] = 30;
    add_channels(sky, {"R", "G", "B"}, pixels, 3);
    write_exr(folder / "sky.exr", sky);
    Row row;
    row.walls = false;
    row.next();
    row.next(0.1);
    row.scene.optics()["environment"] = {{"class", "image"}, {"file", "sky.exr"}, {"rotation", 0.4}};
    Comparison c;
    row.finish(c);
    check_against_backward(row.scene, c, folder / "scene.gltf");
}

TEST_CASE("algorithms agree: smooth glass, a mirror and what is seen in them") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 2);
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.1, 0.2, 0.4}}});
    const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    s.sphere(0.7, glass, at(-0.8, -1, 0.2));
    s.sphere(0.7, s.surface(metal(0)), at(0.8, -1.2, -0.4));
    check_against_backward(s);
}

// All light passes a slab of glass from wall to wall, so merging may bring any of it, and with wide disks of
// small pixels it brings much of what other ways bring, too: a wrong weight between them shows from about
// 1.2 % on. Narrow lobes of a rough metal are connected to and merged after.
TEST_CASE("algorithms agree: wide disks of merging under a slab of glass") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 2);
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.1, 0.2, 0.4}}});
    const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    add_box(s, {4.2f, 0.1f, 4.2f}, glass, false, at(0, 1.5, 0));
    s.sphere(0.7, glass, at(-0.8, -1, 0.2));
    s.sphere(0.7, s.surface(metal(0.02)), at(0.8, -1.2, -0.4));
    Comparison c;
    c.width = 160, c.height = 120;
    c.backward = 16, c.forward = 0, c.bidirectional = 2;
    c.tolerance = 0.004;  // bias of the radius
    c.merge_radius = 1;
    c.unconnected = true;
    check_against_backward(s, c);
}

TEST_CASE("algorithms agree: rough glass that absorbs inside" * doctest::test_suite("long")) {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.1, 0.4, 0.8}}});
    const auto rough = [&](double alpha, bool multiscatter) {
        return s.material(
            {{"surface", {{"class", "dielectric"}, {"alpha", alpha}, {"multiscatter", multiscatter}}},
             {"inside", "glass"}});
    };
    s.sphere(0.7, rough(0.3, false), at(-0.9, -1, 0.2));
    s.sphere(0.5, rough(0.1, false), at(0.9, -1.2, 0.4));
    add_box(s, {1.2f, 0.3f, 1.2f}, rough(0.3, true), false, at(0.5, 0.4, -0.6));
    check_against_backward(s);
}

TEST_CASE("algorithms agree: panes and sheets of alpha between light, object and camera") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.sphere(0.3, s.black_emitter({6, 4, 3}),
             at(1.2, 1.2, 0.5));  // no point: backward rays must meet it in the panes
    const int pane = s.surface({{"class", "thin_dielectric"}});
    const int sheet = s.material(
        json::object(),
        {{"alphaMode", "BLEND"},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.8, 0.6, 0.4, 0.5}}, {"metallicFactor", 0.2}, {"roughnessFactor", 0.6}}}});
    s.rectangle(2, 2, pane, hanging(-0.5, 0.8, 0));
    s.rectangle(2, 2, sheet, hanging(0.7, 0.2, -0.5));
    s.rectangle(1, 1, pane, at(-0.5, -0.3, 1));
    s.rectangle(1, 1, sheet, at(0.5, -0.6, 0.9));
    s.sphere(0.6, s.surface(metal(0.2)), at(0, -1.3, -0.3));
    check_against_backward(s);
}

TEST_CASE("algorithms agree: principled materials with textures and normal maps" *
          doctest::test_suite("long")) {
    const TemporaryFolder folder;
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    s.document["extensionsUsed"].push_back("KHR_materials_transmission");
    const int color = add_texture(s, folder, "color", 8, [](float u, float v) {
        return glm::vec3(0.2f + 0.8f * u, 0.9f - 0.5f * v, int(8 * u + 8 * v) % 2 ? 0.9f : 0.3f);
    });
    const int mixed = add_texture(s, folder, "mixed", 8, [](float u, float v) {
        return glm::vec3(1, 0.4f + 0.5f * v, u < 0.5f ? 0.0f : 0.9f);  // green roughness, blue metallic
    });
    const int bumps = add_texture(s, folder, "bumps", 8, [](float u, float v) {
        const glm::vec3 n = glm::normalize(glm::vec3(0.6f * std::sin(13 * u), 0.6f * std::cos(11 * v), 1));
        return 0.5f * n + 0.5f;
    });
    const auto principled = [&](json pbr, json more = json::object()) {
        more["pbrMetallicRoughness"] = std::move(pbr);
        more["normalTexture"] = {{"index", bumps}};
        return s.material(json::object(), more);
    };
    const json base = {{"index", color}}, rough = {{"index", mixed}};
    add_coarse_sphere(s, 0.6f, principled({{"baseColorTexture", base}, {"metallicRoughnessTexture", rough}}),
                      at(-1.1, -1.3, 0.3));
    add_coarse_sphere(
        s, 0.6f, principled({{"baseColorTexture", base}, {"metallicFactor", 1}, {"roughnessFactor", 0.5}}),
        at(0.2, -1.3, -0.6));
    add_coarse_sphere(
        s, 0.6f,
        principled({{"baseColorTexture", base}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}},
                   {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.8}}}}}}),
        at(1.2, -1.3, 0.3));
    check_against_backward(s, {}, folder / "scene.gltf");
}

TEST_CASE("algorithms agree: coarse meshes with smooth normals") {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 0.8);
    add_coarse_sphere(s, 0.6f, s.lambertian(0.8), at(-1.1, -1.2, 0.2));
    add_coarse_sphere(s, 0.6f, s.surface(metal(0.2)), at(0.2, -0.9, -0.6));
    s.medium("glass", {{"ior", 1.5}});
    add_coarse_sphere(
        s, 0.6f, s.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.2}}}, {"inside", "glass"}}),
        at(1.2, -1.2, 0.2));
    check_against_backward(s);
}

TEST_CASE("algorithms agree: coarse mirrors and glass with smooth normals" * doctest::test_suite("long")) {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 2);
    add_coarse_sphere(s, 0.7f, s.surface(metal(0)), at(-0.9, -1.1, 0.1));
    s.medium("glass", {{"ior", 1.5}});
    add_coarse_sphere(s, 0.7f, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                      at(0.9, -1.1, 0.1));
    check_against_backward(s);
}

TEST_CASE("algorithms agree: shapes and copies of a mesh under scales that differ by axis" *
          doctest::test_suite("long")) {
    SceneBuilder s;
    add_room(s);
    const int lamp = s.black_emitter({3, 3.3, 3.6});
    s.sphere(0.5, lamp, at(0, 1.3, 0));
    s.scale_last({1.6, 0.5, 1});
    s.medium("glass", {{"ior", 1.5}, {"absorption", 0.3}});
    s.sphere(0.6, s.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.2}}}, {"inside", "glass"}}),
             at(-1, -1.1, 0.3));
    s.scale_last({1, 1.3, 0.6});
    s.sphere(0.6, s.surface(metal(0.2)), at(1, -1.2, 0.3));
    s.scale_last({1.2, 0.7, 0.8});
    add_coarse_sphere(s, 0.5f, s.lambertian({0.4, 0.6, 0.8}), {{0, -1.3, -0.9}, {0.1, 0.2, 0.3, 0.927}});
    s.scale_last({1.4, 0.6, 0.9});
    check_against_backward(s);
}

TEST_CASE("algorithms agree: a narrow beam from near and from far") {
    for (const double distance : {1.0, 1000.0}) {
        CAPTURE(distance);
        const double angle = 0.4 / distance;  // the beam is 0.8 m wide where it ends
        SceneBuilder s;
        s.rectangle(2, 2, s.lambertian({0.6, 0.5, 0.4}), at(0, 0, 0));
        s.rectangle(0.5, 0.5, s.lambertian(0.7), facing_x(-0.4, 0, 0.25));
        s.light({{"type", "spot"},
                 {"intensity", 10 * distance * distance},
                 {"spot", {{"innerConeAngle", angle / 2}, {"outerConeAngle", angle}}}},
                at(0.05, 0, distance));
        s.orthographic(0.6, at(0, 0, 0.9));
        Comparison c;
        c.width = c.height = 24;
        check_against_backward(s, c);
    }
}
