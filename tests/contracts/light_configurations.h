// Lights of every class as the tests make them.
#pragma once
#include <random>
#include <string>
#include <vector>

#include "tests/support/light_probe.h"
#include "tests/support/source_path.h"

namespace etendue {

// A bright patch, dark regions and colour: what an alias table can get wrong.
inline ImageDescription probe_image(uint32_t width, uint32_t height) {
    ImageDescription image;
    image.name = "probe";
    image.width = width, image.height = height;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    for (uint32_t i = 0; i < width * height; ++i) {
        const uint32_t x = i % width, y = i / width;
        float v = uniform(random) * 0.2f + (y < height / 2 ? 0.5f : 0.05f);
        if (x >= width / 4 && x < width / 2 && y > height / 2) v = 0;
        image.rgba32f.insert(image.rgba32f.end(), {v, v * uniform(random), v * 0.5f, 1});
    }
    for (int c = 0; c < 3; ++c)
        image.rgba32f[((height / 4) * width + width - 1) * 4 + c] = 20;  // beside the seam
    for (int c = 0; c < 3; ++c) image.rgba32f[(width / 2) * 4 + c] = 5;  // beside the pole
    return image;
}

// Of those that stand beside the tests of the readers.
inline std::string photometric_file(const std::string& name) {
    return source_path("tests/host/photometry/" + name);
}

struct LightConfiguration {
    std::string label;
    nlohmann::json parameters;
    glm::dmat4 placement{1.0};
    ImageDescription image;  // of a parameter `file`
    glm::vec3 point{0.3f, 0.2f, -0.4f};
};

// A node at (1, 2, -3) that turns -z to (0.6, -0.8, 0), enlarged: scale must not matter.
inline glm::dmat4 tilted_node() {
    glm::dmat4 m(1.0);
    m[2] = glm::dvec4(-0.6, 0.8, 0, 0) * 3.0;
    m[0] = glm::dvec4(0.8, 0.6, 0, 0) * 3.0;
    m[1] = glm::dvec4(0, 0, 1, 0) * 3.0;
    m[3] = glm::dvec4(1, 2, -3, 1);
    return m;
}

inline std::vector<LightConfiguration> light_configurations(const std::string& name) {
    if (name == "point") return {{"", {{"intensity", 7}, {"color", {1, 0.5, 0.25}}}, tilted_node(), {}, {}}};
    if (name == "spot")
        return {
            {"wide",
             {{"intensity", 7}, {"inner_cone_angle", 0.4}, {"outer_cone_angle", 1.2}},
             tilted_node(),
             {},
             {}},
            {"narrow", {{"inner_cone_angle", 0.0005}, {"outer_cone_angle", 0.001}}, tilted_node(), {}, {}},
            {"sharp", {{"inner_cone_angle", 0.5}, {"outer_cone_angle", 0.5}}, tilted_node(), {}, {}}};
    if (name == "directional") return {{"", {{"intensity", 5}}, tilted_node(), {}, {}}};
    if (name == "constant") return {{"", {{"radiance", {1, 2, 3}}}, glm::dmat4(1.0), {}, {}}};
    if (name == "image")
        return {
            {"16 x 8", {{"file", "f"}, {"scale", 2}}, glm::dmat4(1.0), probe_image(16, 8), {}},
            {"7 x 5, turned", {{"file", "f"}, {"rotation", 1.234}}, glm::dmat4(1.0), probe_image(7, 5), {}},
            {"64 x 32", {{"file", "f"}, {"rotation", -2}}, glm::dmat4(1.0), probe_image(64, 32), {}},
            {"1 x 1", {{"file", "f"}}, glm::dmat4(1.0), probe_image(1, 1), {}}};
    if (name == "sky")  // without the sun: its disk is finer than any cells (sky_test.cpp)
        return {
            {"uniform, black ground", {{"type", 5}, {"diffuse", 3}, {"ground", 0}}, glm::dmat4(1.0), {}, {}},
            {"overcast", {{"type", 1}, {"diffuse", 3}, {"color", {1, 0.5, 2}}}, glm::dmat4(1.0), {}, {}},
            {"clear", {{"type", 12}, {"diffuse", 3}, {"sun", {0.5, 0.3, 0.7}}}, glm::dmat4(1.0), {}, {}},
            {"polluted, low sun",
             {{"type", 15}, {"diffuse", 3}, {"sun", {-1, 0.05, 0.2}}},
             glm::dmat4(1.0),
             {},
             {}}};
    if (name == "ies") {
        std::vector<LightConfiguration> all;
        for (const char* file : {"own_asym_0_360.ies", "own_lambert_type_b_quarter.ies"})
            all.push_back({file,
                           {{"file", photometric_file(file)}, {"turn", 0.7}},
                           tilted_node(),
                           {},
                           {0.7f, 0.2f, -3}});
        return all;
    }
    if (name == "rays")
        return {{"",
                 {{"file", source_path("tests/host/rays/own_3rays_wavelength.tm25ray")}},
                 tilted_node(),
                 {},
                 {0.7f, 0.2f, -3}}};
    // From points of which some see all of what lights them, some a part.
    if (name == "collimated")
        return {
            {"parallel", {{"radius", 0.5}}, tilted_node(), {}, {1.6f, 1.2f, -3}},
            {"narrow",
             {{"radius", 0.5}, {"divergence", 0.01}, {"power", 7}},
             tilted_node(),
             {},
             {1.6f, 1.2f, -3}},
            {"at its edge", {{"radius", 0.5}, {"divergence", 0.2}}, tilted_node(), {}, {1.9f, 1.5f, -3.1f}},
            {"wide", {{"radius", 0.01}, {"divergence", 1.4}}, tilted_node(), {}, {1.9f, 1.5f, -3.1f}}};
    return {};
}

inline LightProbe make_light(const std::string& name, const LightConfiguration& c) {
    return LightProbe(name, c.parameters, c.placement, c.image);
}

inline double luminance(glm::vec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

}  // namespace etendue
