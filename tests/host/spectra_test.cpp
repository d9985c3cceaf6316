// Spectra, colours and wavelengths against tabulated and closed values.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include "host/error.h"
#include "host/scene/spectral_value.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"
#include "host/spectra/wavelengths.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

SpectralValue value_of(const json& value, SpectralKind kind, const SceneDescription& scene = {}) {
    return spectral_value(value, scene, "/here", kind);
}

SpectralTable table_of(const json& value, SpectralKind kind) { return value_of(value, kind).as_table(kind); }

glm::dvec2 chromaticity(const SpectralTable& radiance) {
    const glm::dvec3 xyz = xyz_of_radiance(radiance);
    return {xyz.x / (xyz.x + xyz.y + xyz.z), xyz.y / (xyz.x + xyz.y + xyz.z)};
}

std::string message_of(const json& value, SpectralKind kind, const SceneDescription& scene = {}) {
    try {
        value_of(value, kind, scene);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

double relative_difference(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b) / glm::length(b);
}

}  // namespace

TEST_CASE("illuminants and blackbodies have their chromaticity and luminance") {
    const auto radiance = SpectralKind::radiance;
    const auto check = [](const SpectralTable& t, double x, double y, double tolerance) {
        CHECK(chromaticity(t).x == doctest::Approx(x).epsilon(tolerance));
        CHECK(chromaticity(t).y == doctest::Approx(y).epsilon(tolerance));
    };
    // CIE 15:2018, tables T.3 and T.8.1 (2 degrees).
    check(table_of({{"illuminant", "D65"}}, radiance), 0.31272, 0.32903, 1e-4);
    check(table_of({{"illuminant", "A"}}, radiance), 0.44758, 0.40745, 1e-4);
    check(table_of({{"illuminant", "E"}}, radiance), 1.0 / 3, 1.0 / 3, 1e-4);
    check(table_of({{"illuminant", "F2"}}, radiance), 0.3721, 0.3751, 1e-3);
    check(table_of({{"illuminant", "F11"}}, radiance), 0.3805, 0.3769, 1e-3);
    for (const char* name : {"D65", "A", "E", "F2", "F11"})
        CHECK(xyz_of_radiance(table_of({{"illuminant", name}}, radiance)).y ==
              doctest::Approx(1).epsilon(1e-6));
    // Illuminant A is Planck's law at 2856 K with c2 = 1.435e-2 m K of its time: 2855.5 K with today's.
    check(table_of({{"blackbody", 2855.5}}, radiance), 0.44758, 0.40745, 1e-4);
    // The candela of 1948: platinum at its melting point, 2041 K, has 6e5 cd/m².
    CHECK(xyz_of_radiance(table_of({{"blackbody", 2041.4}}, radiance)).y ==
          doctest::Approx(6e5).epsilon(0.01));
    // Stefan and Boltzmann: the integral over all wavelengths is sigma T^4 / pi.
    double sum = 0;
    for (double nm = 50.5; nm < 200000; nm += 1) sum += blackbody_radiance(3000, nm);
    CHECK(sum == doctest::Approx(5.670374419e-8 * std::pow(3000.0, 4) / M_PI).epsilon(1e-4));
}

TEST_CASE("glasses have the refractive index and the Abbe number of their catalogue") {
    const auto check = [](const char* name, double index, double abbe) {
        const SpectralValue ior = value_of({{"name", std::string(name) + " ior"}}, SpectralKind::index);
        CAPTURE(name);
        CHECK(ior.rgb.x == doctest::Approx(index).epsilon(1e-4));
        const double f = ior.table->at(486.13), d = ior.table->at(587.56), c = ior.table->at(656.27);
        CHECK((d - 1) / (f - c) == doctest::Approx(abbe).epsilon(5e-3));
    };
    // Schott data sheets; Malitson 1965; Sultanova et al. 2009; Daimon & Masumura 2007.
    check("BK7", 1.51680, 64.17);
    check("SF11", 1.78472, 25.76);
    check("fused silica", 1.45846, 67.82);
    check("PMMA", 1.4906, 53.2);
    check("polycarbonate", 1.5848, 27.9);
    check("water", 1.33336, 55.8);
    CHECK(value_of({{"cauchy", {1.5, 0.01}}}, SpectralKind::index).table->at(500) == doctest::Approx(1.54));
}

TEST_CASE("white under D65 is (1, 1, 1), and grey stays even") {
    CHECK(relative_difference(rgb_of_radiance(white_light()), glm::dvec3(1)) < 1e-6);
    CHECK(relative_difference(rgb_of_factor(constant_spectrum(0.3)), glm::dvec3(0.3)) < 1e-6);
    CHECK(factor_of_rgb({0.25, 0.25, 0.25}) == constant_spectrum(0.25));
    CHECK(relative_difference(rgb_of_radiance(radiance_of_rgb({7, 7, 7})), glm::dvec3(7)) < 1e-6);
}

TEST_CASE("spectra of colours look like the colours, and stay between 0 and 1") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(0, 1);
    double worst = 0, worst_light = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 rgb(u(random), u(random), u(random));
        const SpectralTable factor = factor_of_rgb(rgb);
        CHECK(factor.least() >= 0);
        CHECK(factor.greatest() <= 1);
        worst = std::max(worst, glm::length(rgb_of_factor(factor) - rgb));
        worst_light = std::max(worst_light,
                               relative_difference(rgb_of_radiance(radiance_of_rgb(50.0 * rgb)), 50.0 * rgb));
    }
    CHECK(worst < 2e-3);
    CHECK(worst_light < 2e-3);
}

TEST_CASE("a pass has four wavelengths whose sum over passes is the integral") {
    double total = 0;
    for (int nm = first_nm; nm < last_nm; ++nm) total += wavelength_pdf(nm + 0.5);
    CHECK(total == doctest::Approx(1).epsilon(1e-9));

    // The lanes estimate the colour of a spectrum together; the hero does alone. Even and odd passes do each
    // in themselves.
    const SpectralTable spectrum = table_of({{"illuminant", "A"}}, SpectralKind::radiance);
    const glm::dvec3 expected = rgb_of_radiance(spectrum);
    for (const uint32_t seed : {1u, 2u}) {
        glm::dvec3 all(0), half[2] = {glm::dvec3(0), glm::dvec3(0)}, hero(0);
        constexpr int passes = 512;
        for (int pass = 0; pass < passes; ++pass) {
            const Wavelengths w = choose_wavelengths(pass, seed);
            for (int lane = 0; lane < 4; ++lane) {
                CHECK(w.nm[lane] >= first_nm);
                CHECK(w.nm[lane] <= last_nm);
                const glm::dvec3 brought =
                    glm::dvec3(w.rgb[lane]) * spectrum.at(w.nm[lane]) * even_luminance() / double(passes);
                all += brought;
                half[pass % 2] += 2.0 * brought;
                if (lane == 0) hero += 4.0 * brought;
            }
        }
        CHECK(relative_difference(all, expected) < 1e-3);
        CHECK(relative_difference(half[0], expected) < 2e-3);
        CHECK(relative_difference(half[1], expected) < 2e-3);
        CHECK(relative_difference(hero, expected) < 1e-2);
        CHECK(half[0] != half[1]);
    }
    CHECK(choose_wavelengths(3, 1).nm != choose_wavelengths(3, 2).nm);
}

TEST_CASE("spectra are read from tables and files") {
    const TemporaryFolder folder;
    std::ofstream(folder / "paint.csv")
        << "wavelength (nm),reflectance\n# measured\n400, 0.25\n\n700,0.75  # end\n";
    SceneDescription scene;
    scene.file = "scene.gltf", scene.folder = folder.path;
    scene.spectra["paint"] = {{"file", "paint.csv"}};
    scene.spectra["again"] = {{"name", "paint"}};
    const SpectralValue paint = value_of({{"name", "paint"}}, SpectralKind::factor, scene);
    CHECK(paint.table->at(550) == doctest::Approx(0.5));
    CHECK(paint.table->at(800) == doctest::Approx(0.75));  // held
    const SpectralValue lamp = value_of({{"file", "paint.csv"}}, SpectralKind::radiance, scene);
    CHECK(lamp.table->at(800) == 0);  // a lamp sends nothing that its table does not say
    CHECK(value_of({{"wavelengths", {500}}, {"values", {2}}}, SpectralKind::factor).table->at(600) == 2);

    std::ofstream(folder / "bad.csv") << "400,1\n500\n";
    const auto factor = SpectralKind::factor;
    CHECK(message_of({{"file", "bad.csv"}}, factor, scene).find("bad.csv:2: allowed: lines of two numbers") !=
          std::string::npos);
    CHECK(message_of({{"file", "none.csv"}}, factor, scene).find("cannot read") != std::string::npos);
    CHECK(message_of({{"name", "again"}}, factor, scene).find("names another one") != std::string::npos);
    CHECK(message_of({{"name", "no such"}}, factor, scene).find("BK7 ior") != std::string::npos);
    CHECK(message_of({{"wavelengths", {500, 400}}, {"values", {1, 2}}}, factor)
              .find("numbers above 0 that rise") != std::string::npos);
    CHECK(message_of({{"wavelengths", {500, 600}}, {"values", {1}}}, factor).find("as many of both") !=
          std::string::npos);
    CHECK(message_of({{"blackbody", 3}}, factor).find("[100, 1e6] K") != std::string::npos);
    CHECK(message_of({{"illuminant", "Q"}}, factor).find("allowed: A, D65, E, F1 to F12") !=
          std::string::npos);
    CHECK(message_of({{"sellmeier", {1, 2, 3}}}, factor).find("as many B as C") != std::string::npos);
    CHECK(message_of({{"cauchy", {-3}}}, factor).find("refractive index") != std::string::npos);
    CHECK(message_of("red", factor).find("not a spectral value") != std::string::npos);
}
