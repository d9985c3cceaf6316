// Spectra in whole renders: colours of lights, metals and paints against integrals over the wavelengths, and
// the angles at which a prism sends them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/spectral_value.h"
#include "host/spectra/color.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

SpectralTable table_of(const json& value, SpectralKind kind) {
    return spectral_value(value, {}, "/test", kind).as_table(kind);
}
SpectralTable light(const json& value) { return table_of(value, SpectralKind::radiance); }

struct Patch {
    std::string name;
    std::function<int(SceneBuilder&)> material;
    glm::dvec3 color;  // that it must show under even light of D65 with luminance 1
};

json metal_of_color(const glm::dvec3& c) {
    return {{"pbrMetallicRoughness", {{"baseColorFactor", {c.x, c.y, c.z, 1}}, {"roughnessFactor", 0}}}};
}

Patch emitter(const std::string& name, const json& radiance) {
    return {name, [=](SceneBuilder& s) { return s.black_emitter(radiance); },
            rgb_of_radiance(light(radiance))};
}

Patch gold() {
    const auto value = [](const char* name) { return table_of({{"name", name}}, SpectralKind::factor); };
    const SpectralTable n = value("Au eta"), k = value("Au k");
    SpectralTable reflected;
    for (int i = 0; i < spectrum_samples; ++i) {
        const double a = n.values[i], b = k.values[i] * k.values[i];
        reflected.values[i] = float(((a - 1) * (a - 1) + b) / ((a + 1) * (a + 1) + b));
    }
    const json surface = {{"class", "conductor"}, {"eta", {{"name", "Au eta"}}}, {"k", {{"name", "Au k"}}}};
    return {"gold", [=](SceneBuilder& s) { return s.surface(surface); },
            rgb_of_radiance(white_light() * reflected)};
}

std::vector<Patch> patches() {
    const json paint = {{"wavelengths", {380, 480, 520, 600, 700}}, {"values", {0.1, 0.7, 0.05, 0.9, 0.3}}};
    std::vector<Patch> list = {
        emitter("a lamp like illuminant A", {{"illuminant", "A"}}),
        emitter("a fluorescent lamp", {{"illuminant", "F11"}}),
        emitter("a glowing body", {{"blackbody", 1800}}),
        emitter("a colour", {3, 1, 0.25}),
        {"lumens of a spectrum",
         [](SceneBuilder& s) {
             return s.material({{"surface", {{"class", "absorber"}}},
                                {"emission", {{"luminance", 20}, {"spectrum", {{"illuminant", "F2"}}}}}});
         },
         20.0 * rgb_of_radiance(light({{"illuminant", "F2"}}))},
        gold(),
        {"paint", [=](SceneBuilder& s) { return s.lambertian(paint); },
         rgb_of_radiance(white_light() * table_of(paint, SpectralKind::factor))},
    };
    // Colours of textures and factors become spectra on the device, by interpolation of fits.
    for (const glm::dvec3 c :
         {glm::dvec3(1, 1, 1), glm::dvec3(0.5, 0.5, 0.5), glm::dvec3(0.9, 0.4, 0.1),
          glm::dvec3(0.05, 0.3, 0.75), glm::dvec3(0.2, 0.21, 0.19), glm::dvec3(0.3, 0.8, 0.25)})
        list.push_back({"a metal of colour",
                        [=](SceneBuilder& s) { return s.material(json::object(), metal_of_color(c)); }, c});
    return list;
}

}  // namespace

TEST_CASE("lights, metals and paints have the colours that their spectra have") {
    const std::vector<Patch> row = patches();
    SceneBuilder scene;
    for (size_t i = 0; i < row.size(); ++i)
        scene.rectangle(2, 2, row[i].material(scene), at(2 * double(i) + 1, 0, 0));
    scene.environment({{"illuminant", "D65"}});
    scene.orthographic(1, at(double(row.size()), 0, 1));
    RenderPlan plan;
    plan.width = uint32_t(row.size()), plan.height = 1, plan.passes = 1024, plan.seeds = 4;
    Scene compiled = compile_test_scene(scene.import());
    REQUIRE(compiled.features.spectral);
    const Estimates e = render_estimates(compiled, plan);
    for (uint32_t i = 0; i < row.size(); ++i) {
        CAPTURE(row[i].name);
        const double y = glm::dot(row[i].color, glm::dvec3(0.2126, 0.7152, 0.0722));
        for (int c = 0; c < 3; ++c) {
            CAPTURE(c);
            CHECK(std::fabs(e.at(i, 0, c) - row[i].color[c]) < 0.008 * y);
        }
    }
    // More passes than the device is told of at once, in one batch or two, in one kernel or several.
    const FilmState fused = render_film(compiled, plan, Schedule::fused, {150});
    CHECK(render_film(compiled, plan, Schedule::wavefront, {50, 100}).pixels == fused.pixels);
}

namespace {

constexpr double degree = std::numbers::pi / 180;

// Of a material of glass with smooth faces: its index by the wavelength in nm, and it.
struct Glass {
    std::function<double(double)> index;
    std::function<int(SceneBuilder&)> material;
};

// A ray meets the first face of a prism so that yellow light (the d line) goes through symmetrically, which
// turns it least: Snell's law at both faces says where a line goes. A strip that the ray of the line just
// meets, 0.01 degrees to either side and emitting that line alone, is seen; that of the other line is not.
void check_prism(const Glass& glass, double yellow_deviation, double spread) {
    constexpr double apex = 60 * degree, distance = 10;  // m
    const double incidence = std::asin(glass.index(587.6) * std::sin(apex / 2));
    CHECK(2 * incidence - apex == doctest::Approx(yellow_deviation).epsilon(1e-3));
    const auto deviation = [&](double nm) {
        const double inside = apex - std::asin(std::sin(incidence) / glass.index(nm));
        return incidence + std::asin(glass.index(nm) * std::sin(inside)) - apex;
    };
    // In the plane y = 0, angles from -z towards -x: the direction of a ray, or of a normal.
    const auto along = [](double angle) { return glm::dvec3(-std::sin(angle), 0, -std::cos(angle)); };
    // A rectangle at `position` whose front faces away from along(angle): rotated about y.
    const auto facing = [](const glm::dvec3& position, double angle) {
        return Place{position, {0, std::sin(angle / 2), 0, std::cos(angle / 2)}};
    };

    struct Line {
        int nm;
        double angle;
        json radiance;
    };
    const auto line = [&](int nm) {
        return Line{nm, deviation(nm), {{"wavelengths", {nm - 1, nm, nm + 1}}, {"values", {0, 1e6, 0}}}};
    };
    const Line blue = line(486), red = line(656);
    CHECK(blue.angle - red.angle == doctest::Approx(spread).epsilon(0.1));

    for (const auto& [emitted, placed] : {std::pair(blue, blue), std::pair(red, red), std::pair(blue, red)}) {
        CAPTURE(emitted.nm);
        CAPTURE(placed.nm);
        SceneBuilder scene;
        const int face = glass.material(scene);
        const double inner = incidence - apex / 2;  // direction of the ray within
        scene.rectangle(0.01, 0.01, face, facing({0, 0, 0}, incidence));
        const glm::dvec3 exit = 0.02 * along(inner);
        scene.rectangle(0.01, 0.01, face, facing(exit, incidence - apex + std::numbers::pi));
        const double width = 2 * distance * std::tan(0.01 * degree);
        scene.rectangle(width, 0.1, scene.black_emitter(emitted.radiance),
                        facing(exit + distance * along(placed.angle), placed.angle));
        scene.orthographic(2e-5, at(0, 0, 0.1));
        RenderPlan plan;
        plan.width = plan.height = 2, plan.passes = 16384, plan.seeds = 2;
        plan.schedule = placed.nm == emitted.nm ? Schedule::fused : Schedule::wavefront;
        Scene compiled = compile_test_scene(scene.import());
        REQUIRE(compiled.features.dispersion);
        const WindowMean seen = window_mean(render_estimates(compiled, plan));
        // Unpolarized light at both faces.
        const double n = glass.index(emitted.nm), t = std::asin(std::sin(incidence) / n);
        const auto transmitted = [&](double c1, double c2) {
            const double s = (c1 - n * c2) / (c1 + n * c2), p = (n * c1 - c2) / (n * c1 + c2);
            return 1 - 0.5 * (s * s + p * p);
        };
        const glm::dvec3 rgb = std::pow(transmitted(std::cos(incidence), std::cos(t)), 2) *
                               rgb_of_radiance(light(emitted.radiance));
        if (emitted.nm == placed.nm)
            CHECK(seen.mean == doctest::Approx((rgb.x + rgb.y + rgb.z) / 3).epsilon(0.1));
        else
            CHECK(seen.mean == 0);
    }
}

}  // namespace

TEST_CASE("a prism of BK7 turns each line by its angle") {
    const SpectralTable ior = table_of({{"name", "BK7 ior"}}, SpectralKind::index);
    const auto material = [](SceneBuilder& scene) {
        scene.medium("glass", {{"ior", {{"name", "BK7 ior"}}}});
        return scene.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
    };
    check_prism({[&](double nm) { return ior.at(nm); }, material}, 38.65 * degree, 0.71 * degree);
}

TEST_CASE("a prism of KHR_materials_dispersion turns each line by its angle") {
    // Of Abbe number 70, by the formula of the extension.
    const auto index = [](double nm) { return 1.6 + 0.6 / 70 * (523655 / (nm * nm) - 1.5168); };
    const auto material = [](SceneBuilder& scene) {
        scene.document["materials"].push_back(
            {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
             {"extensions",
              {{"KHR_materials_ior", {{"ior", 1.6}}},
               {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
               {"KHR_materials_volume", {{"thicknessFactor", 1}}},
               {"KHR_materials_dispersion", {{"dispersion", 20 / 70.0}}}}}});
        return int(scene.document["materials"].size()) - 1;
    };
    check_prism({index, material}, 46.26 * degree, 0.82 * degree);
}

TEST_SUITE("long") {
    TEST_CASE("algorithms agree: dispersive glass, coloured walls and a fluorescent lamp") {
        SceneBuilder scene;
        scene.medium("flint", {{"ior", {{"name", "SF11 ior"}}},
                               {"absorption", {{"wavelengths", {400, 700}}, {"values", {2, 0.1}}}}});
        scene.sphere(0.4, scene.material({{"surface", {{"class", "dielectric"}}}, {"inside", "flint"}}),
                     at(0, 0, -0.4));
        scene.sphere(0.3,
                     scene.surface({{"class", "conductor"},
                                    {"eta", {{"name", "Cu eta"}}},
                                    {"k", {{"name", "Cu k"}}},
                                    {"alpha", 0.2}}),
                     at(0.6, 0.3, -0.6));
        const int paint = scene.lambertian({{"wavelengths", {400, 550, 700}}, {"values", {0.2, 0.3, 0.8}}});
        add_box(scene, {2, 2, 2}, paint, true, at(0, 0, 0));
        scene.rectangle(0.8, 0.8, scene.black_emitter({{"illuminant", "F11"}}), facing_down(0, 0, 0.99));
        scene.perspective(1.2, at(0, 0, 0.9));
        Comparison c;
        c.backward = 2048, c.forward = 512, c.bidirectional = 256, c.largest_error = 0.01;
        check_against_backward(scene, c);
    }
}

TEST_CASE("dispersion: the paths of one pass have four hues behind glass, not one") {
    SceneBuilder s;
    s.medium("glass", {{"ior", {{"cauchy", {1.5, 0.01}}}}});
    s.sphere(1, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}), at(0, 0, 0));
    s.environment({1, 1, 1});
    s.orthographic(0.5, at(0, 0, 5));
    const Estimates e = render_estimates(s.import(), {.width = 16, .height = 16, .passes = 1, .seeds = 1});
    int of_hero[4] = {};
    std::vector<double> hues;  // ratios of red to the sum of magnitudes, of the heroes found so far
    for (size_t i = 0; i < e.mean.size(); i += 3) {
        const double sum = std::abs(e.mean[i]) + std::abs(e.mean[i + 1]) + std::abs(e.mean[i + 2]);
        const auto known = std::find_if(hues.begin(), hues.end(),
                                        [&](double hue) { return std::abs(hue - e.mean[i] / sum) < 1e-3; });
        if (known == hues.end()) {
            hues.push_back(e.mean[i] / sum);
            REQUIRE(hues.size() <= 4);
            ++of_hero[hues.size() - 1];
        } else {
            ++of_hero[known - hues.begin()];
        }
    }
    // 64 of 256 each; six standard deviations.
    for (int count : of_hero) CHECK(std::abs(count - 64) < 42);
}
