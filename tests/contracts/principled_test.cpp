// What glTF says of its material, in particular: where its numbers come from.
#include <cmath>

#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"

using namespace etendue;

TEST_CASE("principled: textures and vertex colours multiply their parameters, each from its channel") {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    const auto value = [](double r, double g, double b, double a) {
        return nlohmann::json{{"value", {r, g, b, a}}};
    };
    const nlohmann::json textured = {{"base_color_texture", value(0.5, 0.25, 1, 0.5)},
                                     {"base_color", {0.5, 1, 0.5, 1}},
                                     {"alpha_mode", 2},
                                     {"roughness", 0.8},
                                     {"metallic_roughness_texture", value(0, 0.5, 0.25, 1)},
                                     {"transmission", 1},
                                     {"thin", true},
                                     {"transmission_texture", value(0.5, 0, 0, 1)}};
    const nlohmann::json plain = {
        {"alpha_mode", 2}, {"roughness", 0.4}, {"metallic", 0.25}, {"thin", true}, {"transmission", 0.5}};
    SurfaceProbe probe(registry, "principled", {textured, plain});
    const glm::vec3 wo(0.6f, 0, 0.8f);
    SurfaceSurroundings white, coloured;
    coloured.color = {0.25f, 0.25f, 0.5f, 0.5f};
    std::vector<DirectionPair> pairs;
    for (float z : {0.9f, 0.5f, 0.1f, -0.4f, -0.8f}) pairs.push_back({wo, {-std::sqrt(1 - z * z), 0, z}});
    const auto a = probe.evaluate(0, white, pairs), b = probe.evaluate(1, coloured, pairs);
    for (size_t i = 0; i < pairs.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            CHECK(a[i].f_cos[k] > 0);
            CHECK(a[i].f_cos[k] == doctest::Approx(b[i].f_cos[k]).epsilon(1e-5));
        }
    CHECK(probe.sample(0, white, wo, 64, 1).transparency.x ==
          doctest::Approx(probe.sample(1, coloured, wo, 64, 1).transparency.x).epsilon(1e-6));
}

TEST_CASE("principled: a mask shows where alpha reaches the cutoff and nothing shows elsewhere") {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    SurfaceProbe probe(registry, "principled", {{{"alpha_mode", 1}, {"alpha_cutoff", 0.5}}});
    for (float alpha : {0.0f, 0.499f, 0.5f, 1.0f}) {
        SurfaceSurroundings at;
        at.color.w = alpha;
        CHECK(probe.sample(0, at, {0, 0, 1}, 64, 1).transparency == glm::vec3(alpha < 0.5f ? 1.0f : 0.0f));
    }
}
