// The scene that windows show in tests, and what they must show of it.
#pragma once
#include "tests/preview/window_fixture.h"

namespace etendue {

// A red and a green ball on a plate in white surroundings, seen by two cameras.
inline const std::string two_balls =
    R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
"nodes": [{"translation": [-0.8, 0, 0], "extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": 0.6, "material": 0}}}},
          {"translation": [0.8, 0.2, -1], "extensions": {"ETD_optics": {"geometry": {"class": "sphere", "radius": 0.8, "material": 1}}}},
          {"translation": [0, -0.6, 0], "rotation": [-0.70710678, 0, 0, 0.70710678],
           "extensions": {"ETD_optics": {"geometry": {"class": "rectangle", "size": [4, 4], "material": 2}}}},
          {"name": "front", "camera": 0, "translation": [0, 0.5, 5]},
          {"name": "side", "camera": 1, "translation": [5, 0.3, 0], "rotation": [0, 0.70710678, 0, 0.70710678]}],
"materials": [{"extensions": {"ETD_optics": {"surface": {"class": "lambertian", "reflectance": [0.8, 0.1, 0.1]}}}},
              {"extensions": {"ETD_optics": {"surface": {"class": "lambertian", "reflectance": [0.1, 0.7, 0.1]}}}},
              {"extensions": {"ETD_optics": {"surface": {"class": "lambertian", "reflectance": 0.5}}}}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}},
            {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1.5, "znear": 0, "zfar": 100}}],
"extensions": {"ETD_optics": {"environment": {"class": "constant", "radiance": 1}}}})";

inline const std::vector<std::string> at_rest = {"--passes", "4",           "--exposure",
                                                 "0",        "--algorithm", "backward"};

inline std::vector<std::string> words_with(const std::string& size, std::vector<std::string> more = {}) {
    std::vector<std::string> words = at_rest;
    words.insert(words.end(), {"--size", size});
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

inline Image headless(const Executable& program, const std::string& size,
                      const std::string& receiver = "front") {
    const Run run = program.run({"render", "scene.gltf", "-q", "--passes", "4", "--algorithm", "backward",
                                 "--size", size, "--receiver", receiver, "-o", "image.exr"});
    REQUIRE_MESSAGE(run.code == 0, run.err);
    return read_exr(program.folder / "image.exr");
}

// Half a step by rounding, and what 32-bit logarithms and powers add.
inline constexpr double rounding = 0.6;

inline bool shows(XServer& x, const Image& image, const ViewSettings& settings, double worst = 0) {
    double last = 0;
    const bool shown = x.wait_until([&](const Screenshot& shot) {
        last = greatest_difference(shot, image, settings, worst);
        return last < rounding;
    });
    if (!shown) MESSAGE("greatest difference of the last picture: ", last, "/255");
    return shown;
}

// The headless image of a scene's text.
inline Image headless_image(const std::string& scene, const std::string& size) {
    Executable files;
    write_text(files.folder / "scene.gltf", scene);
    return headless(files, size);
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace etendue
