// Surfaces of glTF's extensions: each alone, then over and under each other.
#include "tests/contracts/surface_configurations.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"

namespace etendue {

std::vector<SurfaceConfiguration> extended_principled() {
    using C = SurfaceConfiguration;
    const auto value = [](double r, double g, double b, double a) {
        return nlohmann::json{{"value", {r, g, b, a}}};
    };
    return {C{"no specular, smooth",
              {{"metallic", 0}, {"roughness", 0}, {"specular", 0}, {"base_color", {0.5, 0.5, 0.5, 1}}},
              1,
              1,
              0.5},
            C{"coloured specular, rough",
              {{"metallic", 0}, {"roughness", 0.4}, {"specular", 0.7}, {"specular_color", {8, 1, 0.1}}}},
            C{"coloured specular on solid glass",
              {{"metallic", 0},
               {"roughness", 0.4},
               {"transmission", 1},
               {"specular", 0.8},
               {"specular_color", {3, 1, 0.2}}},
              1,
              1.5f},
            C{"brushed",
              {{"roughness", 0.3}, {"anisotropy", 0.7}, {"anisotropy_rotation", 0.6}},
              1,
              1,
              {},
              0,
              0.09},
            C{"brushed plastic", {{"metallic", 0}, {"roughness", 0.5}, {"anisotropy", 1}}},
            C{"brushed glass",
              {{"metallic", 0},
               {"roughness", 0.4},
               {"transmission", 1},
               {"anisotropy", 0.5},
               {"anisotropy_texture", value(0.5, 1, 0.9, 1)}},
              1,
              1.5f},
            C{"polished across, brushed along", {{"roughness", 0.1}, {"anisotropy", 0.3}}, 1, 1, {}, 0, 0.01},
            C{"paper, smooth and lossless",
              {{"metallic", 0}, {"roughness", 0}, {"diffuse_transmission", 0.6}},
              1,
              1,
              1.0},
            C{"leaf",
              {{"metallic", 0},
               {"roughness", 0.5},
               {"base_color", {0.3, 0.6, 0.1, 1}},
               {"diffuse_transmission", 0.7},
               {"diffuse_transmission_color", {0.5, 0.9, 0.2}}}},
            C{"wax, index 1.4, smooth and lossless",
              {{"metallic", 0}, {"roughness", 0}, {"diffuse_transmission", 1}},
              1,
              1.4f,
              1.0},
            C{"coat, smooth, on a mirror", {{"roughness", 0}, {"clearcoat", 1}}, 1, 1, 1.0},
            C{"coat with its own normals, rough, on copper",
              {{"roughness", 0.5},
               {"base_color", {0.9, 0.6, 0.4, 1}},
               {"clearcoat", 0.8},
               {"clearcoat_roughness", 0.5},
               {"clearcoat_normal_scale", 1},
               {"clearcoat_normal", {0.25, -0.1, 1}}},
              1,
              1,
              {},
              2e-5,
              1,
              false},
            C{"coat with its own normals, smooth, on brushed metal",
              {{"roughness", 0.4},
               {"anisotropy", 0.5},
               {"anisotropy_rotation", 0.7},
               {"clearcoat", 1},
               {"clearcoat_normal_scale", 2},
               {"clearcoat_normal_texture", value(0.55, 0.45, 1, 1)}},
              1,
              1,
              {},
              2e-5,
              1,
              false},
            C{"coat with steep normals, smooth, on white paint",
              {{"metallic", 0},
               {"specular", 0},
               {"roughness", 0.5},
               {"clearcoat", 1},
               {"clearcoat_normal_scale", 1},
               {"clearcoat_normal", {0.6, -0.4, 1}}},
              1,
              1,
              1.0,
              2e-5,
              1,
              false},
            C{"coat with steep normals, rough, on dark paint",
              {{"metallic", 0},
               {"specular", 0},
               {"base_color", {0.1, 0.1, 0.1, 1}},
               {"clearcoat", 1},
               {"clearcoat_roughness", 0.5},
               {"clearcoat_normal_scale", 1},
               {"clearcoat_normal", {-0.5, 0.7, 1}}},
              1,
              1,
              {},
              2e-5,
              1,
              false},
            C{"coat, smooth, on white paint", {{"metallic", 0}, {"roughness", 0.5}, {"clearcoat", 1}}},
            C{"coat, rough, on copper",
              {{"roughness", 0.5},
               {"base_color", {0.9, 0.6, 0.4, 1}},
               {"clearcoat", 0.8},
               {"clearcoat_roughness", 0.3}}},
            C{"coat, rough, on a mirror", {{"roughness", 0}, {"clearcoat", 1}, {"clearcoat_roughness", 0.4}}},
            C{"coat on smooth glass",
              {{"metallic", 0}, {"roughness", 0}, {"transmission", 1}, {"clearcoat", 1}},
              1,
              1.5f},
            C{"coat on a smooth thin pane, blended",
              {{"metallic", 0},
               {"roughness", 0},
               {"transmission", 0.7},
               {"thin", true},
               {"clearcoat", 1},
               {"base_color", {1, 1, 1, 0.5}},
               {"alpha_mode", 2}}},
            C{"velvet, white, roughness 1",
              {{"metallic", 0}, {"roughness", 0.8}, {"sheen_color", {1, 1, 1}}, {"sheen_roughness", 1}}},
            C{"velvet, red, roughness .5",
              {{"metallic", 0},
               {"roughness", 1},
               {"base_color", {0.4, 0.02, 0.05, 1}},
               {"sheen_color", {0.9, 0.2, 0.3}},
               {"sheen_roughness", 0.5}}},
            C{"velvet, narrow", {{"metallic", 0}, {"roughness", 0}, {"sheen_color", {1, 1, 1}}}},
            C{"film on white plastic, smooth", {{"metallic", 0}, {"roughness", 0}, {"iridescence", 1}}},
            C{"film on white plastic, rough",
              {{"metallic", 0},
               {"roughness", 0.6},
               {"iridescence", 1},
               {"iridescence_ior", 1.8},
               {"iridescence_thickness_maximum", 80}}},
            C{"film on white plastic, roughness 1",
              {{"metallic", 0}, {"iridescence", 1}, {"iridescence_ior", 2.4}, {"ior", 1.2}}},
            C{"film on half metal, textured",
              {{"metallic", 0.5},
               {"roughness", 0.4},
               {"base_color", {0.9, 0.6, 0.3, 1}},
               {"iridescence", 1},
               {"iridescence_texture", value(0.6, 0, 0, 1)},
               {"iridescence_thickness_texture", value(0, 0.3, 0, 1)}}},
            C{"film on solid glass, smooth",
              {{"metallic", 0}, {"roughness", 0}, {"transmission", 1}, {"iridescence", 1}},
              1,
              1.5f,
              1.0},
            C{"film on solid glass, rough",
              {{"metallic", 0}, {"roughness", 0.5}, {"transmission", 1}, {"iridescence", 0.7}},
              1,
              1.5f},
            C{"film on a thin pane",
              {{"metallic", 0}, {"roughness", 0}, {"transmission", 1}, {"thin", true}, {"iridescence", 1}}},
            C{"everything",
              {{"metallic", 0.2},
               {"roughness", 0.5},
               {"transmission", 0.4},
               {"specular", 0.9},
               {"specular_color", {1, 0.7, 0.5}},
               {"anisotropy", 0.6},
               {"iridescence", 0.5},
               {"diffuse_transmission", 0.5},
               {"clearcoat", 0.7},
               {"clearcoat_roughness", 0.2},
               {"sheen_color", {0.3, 0.4, 0.5}},
               {"sheen_roughness", 0.4}},
              1,
              1.4f},
            C{"textured layers",
              {{"metallic", 0},
               {"specular_texture", value(0, 0, 0, 0.5)},
               {"specular_color_texture", value(0.9, 0.5, 0.5, 1)},
               {"diffuse_transmission", 1},
               {"diffuse_transmission_texture", value(0, 0, 0, 0.5)},
               {"diffuse_transmission_color_texture", value(0.9, 0.8, 0.7, 1)},
               {"clearcoat", 1},
               {"clearcoat_texture", value(0.5, 0, 0, 1)},
               {"clearcoat_roughness", 1},
               {"clearcoat_roughness_texture", value(0, 0.4, 0, 1)},
               {"sheen_color", {1, 1, 1}},
               {"sheen_color_texture", value(0.2, 0.3, 0.4, 1)},
               {"sheen_roughness", 1},
               {"sheen_roughness_texture", value(0, 0, 0, 0.6)}}}};
}

}  // namespace etendue

using namespace etendue;

namespace {

ClassRegistry extension_registry() {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    return ClassRegistry(sources);
}

glm::vec3 tilted(double degrees, double azimuth) {
    const double t = glm::radians(degrees), a = glm::radians(azimuth);
    return glm::vec3(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
}

}  // namespace

TEST_CASE("principled: a metal brushed along the tangent scatters along it as its wider roughness says") {
    // Appendix of KHR_materials_anisotropy: alpha 0.16 across, mix(0.16, 1, 0.25) = 0.37 along the direction
    // of the texture (+y), turned by a quarter: -x.
    ClassRegistry registry = extension_registry();
    const nlohmann::json texture = {{"value", {0.5, 1, 1, 1}}};
    SurfaceProbe probe(registry, "principled",
                       {{{"roughness", 0.4},
                         {"anisotropy", 0.5},
                         {"anisotropy_texture", texture},
                         {"anisotropy_rotation", glm::radians(90.0)}},
                        {{"roughness", std::sqrt(0.37)}},
                        {{"roughness", 0.4}}});
    const auto along = [&](size_t record, double azimuth) {
        return probe.evaluate(record, {}, std::vector<DirectionPair>{{{0, 0, 1}, tilted(40, azimuth)}})[0]
            .f_cos.x;
    };
    // At normal incidence only the facet normals' slopes differ; D is split into one factor for each axis,
    // and wider across makes each density smaller by the ratio of the widths.
    const double d = [](double slope2, double a, double b) {
        return 1 / (a * b * std::pow(1 + slope2 / (a * a), 2));
    }(std::pow(std::tan(glm::radians(20.0)), 2), 0.37, 0.16);
    const double iso = 1 / (0.37 * 0.37 * std::pow(1 + std::pow(std::tan(glm::radians(20.0)) / 0.37, 2), 2));
    CHECK(along(0, 0) / along(1, 0) == doctest::Approx(d / iso).epsilon(1e-4));
    CHECK(along(0, 0) == doctest::Approx(along(0, 180)).epsilon(1e-4));
    CHECK(along(0, 90) < 0.5 * along(0, 0));
    CHECK(along(0, 90) / along(2, 90) == doctest::Approx(0.16 / 0.37).epsilon(1e-4));
}

TEST_CASE("principled: coat and sheen are what their extensions say, on a black base") {
    ClassRegistry registry = extension_registry();
    SurfaceProbe probe(registry, "principled",
                       {{{"metallic", 0},
                         {"specular", 0},
                         {"base_color", {0, 0, 0, 1}},
                         {"clearcoat", 0.5},
                         {"clearcoat_roughness", 0.5}},
                        {{"metallic", 0},
                         {"specular", 0},
                         {"base_color", {0, 0, 0, 1}},
                         {"sheen_color", {1, 0.5, 0.25}},
                         {"sheen_roughness", 0.6}}});
    const glm::vec3 wo = tilted(30, 0), wi = tilted(55, 140);
    const std::vector<DirectionPair> pair = {{wo, wi}};
    const glm::dvec3 h = glm::normalize(glm::dvec3(wo) + glm::dvec3(wi));
    // GGX of width 0.25 with separable masking, Schlick's Fresnel term of index 1.5 (glTF, appendix B).
    const double a2 = 0.0625, q = 1 + (a2 - 1) * h.z * h.z, pi = glm::pi<double>();
    const auto g1 = [&](double mu) { return 2 * mu / (mu + std::sqrt(a2 + (1 - a2) * mu * mu)); };
    const double fresnel = 0.04 + 0.96 * std::pow(1 - glm::dot(h, glm::dvec3(wo)), 5);
    const double coat = 0.5 * fresnel * a2 / (pi * q * q) * g1(wo.z) * g1(wi.z) / (4 * wo.z);
    CHECK(probe.evaluate(0, {}, pair)[0].f_cos.x == doctest::Approx(coat).epsilon(1e-4));
    // Charlie of alpha 0.36; masking by the fit of Estevez & Kulla 2017, table 1, blended by (1 - alpha)².
    const double alpha = 0.36, w = (1 - alpha) * (1 - alpha);
    const auto l = [&](double x) {
        return (21.5473 + w * (25.3245 - 21.5473)) /
                   (1 +
                    (3.82987 + w * (3.32435 - 3.82987)) * std::pow(x, 0.19823 + w * (0.16801 - 0.19823))) +
               (-1.97760 + w * (-1.27393 + 1.97760)) * x + (-4.32054 + w * (-4.85967 + 4.32054));
    };
    const auto lambda = [&](double mu) {
        return mu < 0.5 ? std::exp(l(mu)) : std::exp(2 * l(0.5) - l(1 - mu));
    };
    const double d = (2 + 1 / alpha) * std::pow(1 - h.z * h.z, 0.5 / alpha) / (2 * pi);
    const double sheen = d / (4 * wo.z * (1 + lambda(wo.z) + lambda(wi.z)));
    const glm::vec3 value = probe.evaluate(1, {}, pair)[0].f_cos;
    for (int k = 0; k < 3; ++k) CHECK(value[k] == doctest::Approx(sheen / (1 << k)).epsilon(1e-3));
}
