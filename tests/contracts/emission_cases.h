// The lights that tests/contracts/emission_test.cpp asks for rays: each class of the registry, alone in a
// scene.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/image/exr.h"
#include "host/photometry/intensity_distribution.h"
#include "host/photometry/ray_file.h"
#include "tests/support/emission_probe.h"
#include "tests/support/source_path.h"

namespace etendue {

struct EmissionCase {
    std::string class_name, label;
    SceneDescription scene;
    double power_tolerance = 1e-5;  // relative, of what the light states
    MeasuringDisk disk{{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f};
    float extent = 0;  // m, of what rays of a light with a position leave, from there
};

// Two specks at opposite corners make the scene a sphere of radius sqrt(3) around the origin.
inline SceneDescription empty_scene() {
    SceneDescription scene;
    scene.materials.resize(2);
    for (MaterialDescription& material : scene.materials) material.surface.class_name = "absorber";
    MeshDescription specks;
    for (float corner : {-1.0f, 1.0f})
        for (glm::vec3 v : {glm::vec3(0), glm::vec3(-1e-3f, 0, 0), glm::vec3(0, -1e-3f, 0)})
            specks.positions.push_back(glm::vec3(corner) + corner * v);
    specks.triangles = {{0, 1, 2}, {3, 4, 5}};
    scene.meshes.push_back(specks);
    scene.instances.push_back({});
    return scene;
}

inline SceneDescription emissive_scene(bool double_sided) {
    SceneDescription scene = empty_scene();
    scene.materials[1].emission = EmissionDescription{};
    scene.materials[1].emission->value = {3, 2, 1};
    scene.materials[1].double_sided = double_sided;
    return scene;
}

inline SceneDescription shape_scene(const std::string& name, const nlohmann::json& parameters,
                                    const glm::dmat4& m, bool double_sided = false) {
    SceneDescription scene = emissive_scene(double_sided);
    PlacedObject shape;
    shape.object = {name, parameters, "/shape"};
    shape.world_from_local = m;
    shape.material = 1;
    scene.shapes.push_back(shape);
    return scene;
}

inline SceneDescription triangle_scene(bool textured) {
    SceneDescription scene = emissive_scene(false);
    MeshDescription mesh;
    mesh.positions = {{-0.5f, -0.6f, 0.4f}, {0.4f, 0.7f, 0.6f}, {0.7f, -0.5f, 0.3f}};
    mesh.triangles = {{0, 1, 2}};
    mesh.material = 1;
    if (textured) {
        mesh.uv0 = {{0, 0}, {0, 1}, {1, 0}};
        ImageDescription image{.name = "gradient", .width = 2, .height = 2};
        image.rgba32f = {1, 1, 1, 1, 0.5f, 0.2f, 0.1f, 1, 0.3f, 0.6f, 0.9f, 1, 0, 0, 0, 1};
        scene.images.push_back(image);
        scene.textures.push_back({});
        scene.materials[1].emission->texture = {{"index", 0}};
    }
    scene.meshes.push_back(mesh);
    scene.instances.push_back({1});
    return scene;
}

// A bright texel among dim and dark ones, with a turned and repeated map.
inline SceneDescription texel_scene() {
    SceneDescription scene = triangle_scene(true);
    ImageDescription& image = scene.images[0];
    image.width = image.height = 8;
    image.rgba32f.assign(4 * 64, 0);
    for (int i = 0; i < 64; ++i) image.rgba32f[4 * i + 1] = i % 3 == 0 ? 0.0f : 0.2f;
    for (int c = 0; c < 3; ++c) image.rgba32f[4 * 27 + c] = 1;
    scene.materials[1].emission->texture["extensions"]["KHR_texture_transform"] = {{"scale", {1.7, 1.3}},
                                                                                   {"rotation", 0.5}};
    return scene;
}

// Alpha by texture, colour of the vertices and factor.
inline SceneDescription covered_scene() {
    SceneDescription scene = triangle_scene(true);
    scene.images[0].rgba32f = {1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 0.1f, 1, 1, 1, 0.5f};
    scene.materials[1].emission->texture = nullptr;
    scene.materials[1].double_sided = true;
    scene.materials[1].surface = {
        "principled",
        {{"alpha_mode", 2}, {"base_color", {0, 0, 0, 0.8}}, {"base_color_texture", {{"index", 0}}}},
        ""};
    scene.meshes.back().colors = {{1, 1, 1, 1}, {1, 1, 1, 0.5f}, {1, 1, 1, 0.2f}};
    return scene;
}

inline SceneDescription light_scene(const std::string& name, const nlohmann::json& parameters) {
    SceneDescription scene = empty_scene();
    PlacedObject light;
    light.object = {name, parameters, "/light"};
    light.world_from_local[0] *= 2.0;  // scale does not count
    light.world_from_local[2] *= 3.0;
    light.world_from_local[3] = {0, 0, 0.5, 1};
    scene.lights.push_back(light);
    return scene;
}

inline SceneDescription environment_scene(const std::string& name, const nlohmann::json& parameters) {
    SceneDescription scene = empty_scene();
    scene.environment = ObjectDescription{name, parameters, "/environment"};
    return scene;
}

inline std::string environment_file() {
    static const TemporaryFolder folder;
    Image image{.width = 8, .height = 4};
    std::vector<float> texels;
    for (int i = 0; i < 32; ++i)
        for (int c = 0; c < 3; ++c) texels.push_back(i == 13 ? 9.0f : float((7 * i + c) % 5) * 0.3f);
    add_channels(image, {"R", "G", "B"}, texels, 3);
    const auto path = folder / "environment.exr";
    write_exr(path, image);
    return path.string();
}

// Uneven steps, dark parts, a bright corner; of type C light up and down.
inline std::string wild_lamp(IntensityDistribution::Type type, const std::string& opening = "0 0 0") {
    static const TemporaryFolder folder;
    const bool is_c = type == IntensityDistribution::Type::c;
    const std::vector<double> v = is_c ? std::vector<double>{0, 4, 10, 35, 90, 91, 150, 180}
                                       : std::vector<double>{-90, -60, -20, 5, 10, 50, 90},
                              h = is_c ? std::vector<double>{0, 20, 90, 100, 200, 310, 360}
                                       : std::vector<double>{-90, -30, -25, 0, 60, 90};
    std::string text =
        fmt::format("IES:LM-63-2019\nTILT=NONE\n1 -1 1 {} {} {} 2 {}\n1 1 0\n{}\n{}\n", v.size(), h.size(),
                    1 + int(type), opening, fmt::join(v, " "), fmt::join(h, " "));
    for (size_t i = 0; i < h.size(); ++i)
        for (size_t j = 0; j < v.size(); ++j) {
            const bool at_end = !is_c && (i == 0 || j == 0 || i + 1 == h.size() || j + 1 == v.size());
            const bool is_dark = at_end || (is_c && (j == 5 || j == 6));
            const size_t value = (is_c && i + 1 == h.size() ? j : 7 * i + j) % 5 * 3;
            text += fmt::format("{}\n", is_dark ? 0 : j == 2 && i == 2 ? 90 : value);
        }
    const auto file = folder / fmt::format("{} {}.ies", int(type), opening);
    write_text(file, text);
    return file.string();
}

// Rays of which some are dark, and some carry as much as many others. In lumens.
inline std::string uneven_rays() {
    static const TemporaryFolder folder;
    RayFile file;
    file.unit = RayFile::Unit::lumen;
    for (int i = 0; i < 61; ++i) {
        const float turn = 2.4f * float(i), far = std::sqrt(float(i) / 60);
        const glm::vec3 position(200 * far * std::cos(turn), 200 * far * std::sin(turn), float(i));
        const glm::vec3 direction = glm::normalize(glm::vec3(std::sin(turn), std::cos(2 * turn), -1.5f));
        file.rays.push_back({position, direction,
                             i % 7 == 3 ? 0.0f
                             : i == 20  ? 40.0f
                                        : float(i % 5) + 0.25f});
    }
    const auto path = folder / "uneven.tm25ray";
    write_tm25(path, file);
    return path.string();
}

// Rational, and one piece.
inline nlohmann::json bent_patch() {
    nlohmann::json points = nlohmann::json::array();
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const double x = i / 3.0 - 0.5, y = 0.8 * (j / 3.0 - 0.5);
            points.push_back({x, y, -0.25 * x * x - 0.2 * y * y - 0.1 * x * y, 1 + 0.02 * i * j});
        }
    return {{"control_points", points}};
}

inline std::vector<EmissionCase> emission_cases() {
    const auto down = [](double z) {  // +z becomes -z
        return glm::dmat4({1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {0.1, 0, z, 1});
    };
    const glm::dmat4 squeezed({0.9, 0.2, 0, 0}, {0, -0.7, 0.3, 0}, {0.1, 0, -1.2, 0}, {0.1, 0.2, 0.3, 1});
    const MeasuringDisk in_beam{{0.0002f, 0, -0.5f}, {0, 0, 1}, 0.0006f};
    return {
        {"area", "triangle", triangle_scene(false)},
        // Powers of textures are means over points, 16 of each part that is found to be alike.
        {"area", "textured triangle", triangle_scene(true), 0.002},
        {"area", "a bright texel", texel_scene(), 0.01},
        {"area", "there in part, both sides", covered_scene(), 0.01},
        {"area", "disk, both sides", shape_scene("disk", {{"radius", 0.5}}, squeezed, true)},
        {"area", "rectangle", shape_scene("rectangle", {{"size", {0.8, 0.5}}}, down(0.4))},
        {"area", "sphere", shape_scene("sphere", {{"radius", 0.4}}, down(0.4))},
        // The area of a shape under such a map is a mean over 64 points (lib/primitives.glsl).
        {"area", "sphere, squeezed", shape_scene("sphere", {{"radius", 0.4}}, squeezed), 0.01},
        {"area", "cylinder, both sides",
         shape_scene("cylinder", {{"radius", 0.3}, {"height", 0.4}}, down(0.3), true)},
        {"area", "asphere, both sides",
         shape_scene("asphere", {{"curvature", -2}, {"conic", -1}, {"coefficients", {-1}}, {"aperture", 0.4}},
                     down(0.4), true)},
        {"area", "patch, both sides", shape_scene("bezier_patch", bent_patch(), down(0.4), true)},
        {"point", "", light_scene("point", {{"intensity", 7}, {"color", {1, 0.5, 0.25}}})},
        {"spot", "wide", light_scene("spot", {{"inner_cone_angle", 0.3}, {"outer_cone_angle", 0.9}})},
        {"spot", "to a point", light_scene("spot", {{"inner_cone_angle", 0}, {"outer_cone_angle", 1.5}})},
        {"spot", "sharp", light_scene("spot", {{"inner_cone_angle", 0.5}, {"outer_cone_angle", 0.5}})},
        {"spot", "narrow", light_scene("spot", {{"inner_cone_angle", 0.0004}, {"outer_cone_angle", 0.001}}),
         1e-4, in_beam},
        {"ies", "type C",
         light_scene("ies",
                     {{"file", wild_lamp(IntensityDistribution::Type::c)}, {"turn", 1}, {"flux", 50}})},
        {"ies", "type B",
         light_scene("ies", {{"file", wild_lamp(IntensityDistribution::Type::b)}, {"scale", 2}})},
        {"ies", "type A",
         light_scene("ies",
                     {{"file", wild_lamp(IntensityDistribution::Type::a)}, {"color", {1, 0.5, 0.25}}})},
        {"ies",
         "rectangle",
         light_scene("ies", {{"file", wild_lamp(IntensityDistribution::Type::c, "0.3 0.2 0")}, {"turn", 1}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.19f},
        {"ies",
         "tube",
         light_scene("ies", {{"file", wild_lamp(IntensityDistribution::Type::b, "-0.1 0.5 -0.1")}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.26f},
        {"ies",
         "ball",
         light_scene("ies", {{"file", wild_lamp(IntensityDistribution::Type::a, "-0.4 -0.4 -0.4")}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.21f},
        {"ies", "axial",
         light_scene("ies", {{"file", source_path("tests/host/photometry/own_lambert_1986_commas_feet.ies")},
                             {"point", true}})},
        {"rays",
         "uneven",
         light_scene("rays", {{"file", uneven_rays()}, {"flux", 50}, {"color", {1, 0.5, 0.25}}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.7f},
         0.22f},
        {"rays",
         "wavelengths",
         light_scene("rays", {{"file", source_path("tests/host/rays/own_3rays_wavelength.tm25ray")}}),
         1e-5,
         {{0, 0, 0.6f}, {0, 0, -1}, 0.3f},
         0.0024f},
        {"collimated",
         "parallel",
         light_scene("collimated", {{"radius", 0.3}, {"power", 7}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.301f},
        {"collimated",
         "diverging",
         light_scene("collimated", {{"radius", 0.3}, {"divergence", 0.4}, {"color", {1, 0.5, 0.25}}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.301f},
        {"collimated",
         "narrow",
         light_scene("collimated", {{"radius", 0.3}, {"divergence", 0.001}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.301f},
        {"collimated",
         "wide",
         light_scene("collimated", {{"radius", 0.02}, {"divergence", 1.3}}),
         1e-5,
         {{0.1f, 0.05f, -0.5f}, {0, 0, 1}, 0.4f},
         0.021f},
        {"directional", "", light_scene("directional", {{"intensity", 5}})},
        {"constant", "", environment_scene("constant", {{"radiance", {1, 2, 3}}})},
        {"image", "", environment_scene("image", {{"file", environment_file()}, {"rotation", 1}}), 1e-4},
        // Of a map's texels; the sun is that of contracts/sky, since the cells here are far larger.
        {"sky", "of the west",
         environment_scene("sky", {{"type", 8}, {"diffuse", 1}, {"ground", 0.4}, {"sun", {-1, 0.4, 0.3}}}),
         2e-3},
    };
}

}  // namespace etendue
