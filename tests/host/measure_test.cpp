// Figures of meters and their intervals, and chromaticities, without a device.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "host/measure/figures.h"
#include "host/spectra/chromaticity.h"
#include "host/spectra/color_rendering.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"
#include "host/table.h"

using namespace etendue;

namespace {

// Readings of columns x rows pixels around the values of `truth`, with noise of that share of them.
Readings noisy_readings(const std::vector<double>& truth, uint32_t columns, double noise,
                        std::mt19937& random) {
    Readings readings;
    readings.meter = {"desk", "lx", columns, uint32_t(truth.size()) / columns, false, true, {}};
    readings.meter.places.assign(truth.size(), {glm::vec3(0), glm::vec3(0, 0, 1), 0.5f});
    readings.passes = 1;
    std::normal_distribution<double> normal;
    for (double x : truth)
        for (uint32_t k = 0; k < replicates; ++k) {
            ExactSum sum;
            add_exactly(sum, glm::vec3(float(x * (1 + noise * normal(random)))));
            readings.sums.push_back(sum);
        }
    return readings;
}

const Figure& figure(const std::vector<Figure>& figures, const std::string& name) {
    for (const Figure& f : figures)
        if (f.name == name) return f;
    FAIL("no figure ", name);
    return figures[0];
}

}  // namespace

TEST_CASE("Student's factors are those of tables") {
    CHECK(student_factor(2) == doctest::Approx(12.706).epsilon(1e-4));
    CHECK(student_factor(16) == doctest::Approx(2.1314).epsilon(1e-4));
    CHECK(student_factor(31) == doctest::Approx(2.0423).epsilon(1e-4));
    CHECK(student_factor(100000) == doctest::Approx(1.95997).epsilon(1e-4));
    CHECK(std::isinf(student_factor(1)));
}

TEST_CASE("the figures of a meter without noise are exact") {
    std::mt19937 random(1);
    const Readings readings = noisy_readings({100, 200, 300, 400, 500, 600}, 3, 0, random);
    const auto figures = figures_of(readings, {{0.5, 0.25}, {1.0 / 6, 0.75}});
    CHECK(figure(figures, "flux").interval.value == doctest::Approx(1050));
    CHECK(figure(figures, "mean").interval.value == doctest::Approx(350));
    CHECK(figure(figures, "minimum").interval.value == doctest::Approx(100));
    CHECK(figure(figures, "maximum").interval.value == doctest::Approx(600));
    CHECK(figure(figures, "maximum").where.starts_with("column 2, row 1"));
    CHECK(figure(figures, "U0 = minimum / mean").interval.value == doctest::Approx(100.0 / 350));
    CHECK(figure(figures, "Ud = minimum / maximum").interval.value == doctest::Approx(1.0 / 6));
    CHECK(figure(figures, "min / max of 2 points").interval.value == doctest::Approx(0.5));
    CHECK(figure(figures, "min / mean of 2 points").interval.value == doctest::Approx(200.0 / 300));
}

TEST_CASE("intervals hold the truth in 95 % of cases, of means, extremes and ratios alike") {
    std::mt19937 random(2);
    const std::vector<double> truth = {90, 100, 110, 120, 130, 140, 150, 160};
    const std::vector<std::pair<std::string, double>> expected = {{"mean", 125},
                                                                  {"minimum", 90},
                                                                  {"maximum", 160},
                                                                  {"U0 = minimum / mean", 90.0 / 125},
                                                                  {"Ud = minimum / maximum", 90.0 / 160}};
    for (double noise : {0.01, 0.1}) {
        std::vector<int> held(expected.size(), 0);
        const int cases = 300;
        for (int i = 0; i < cases; ++i) {
            const auto figures = figures_of(noisy_readings(truth, 4, noise, random), {});
            for (size_t f = 0; f < expected.size(); ++f) {
                const Interval& interval = figure(figures, expected[f].first).interval;
                held[f] += interval.low <= expected[f].second && expected[f].second <= interval.high;
            }
        }
        for (size_t f = 0; f < expected.size(); ++f) {
            CAPTURE(expected[f].first);
            CAPTURE(noise);
            CHECK(held[f] > 0.91 * cases);
            CHECK(held[f] < 0.99 * cases);
        }
    }
}

TEST_CASE("colours have the chromaticities and temperatures of CIE 15") {
    const auto check = [](const char* illuminant, double x, double y, double kelvin) {
        CAPTURE(illuminant);
        const glm::dvec3 xyz = xyz_of_radiance(library_table(illuminant, Outside::zero));
        CHECK(chromaticity_xy(xyz).x == doctest::Approx(x).epsilon(2e-3));
        CHECK(chromaticity_xy(xyz).y == doctest::Approx(y).epsilon(2e-3));
        CHECK(correlated_color_temperature(xyz).kelvin == doctest::Approx(kelvin).epsilon(2e-3));
    };
    check("illuminant A", 0.44758, 0.40745, 2856);
    check("illuminant D65", 0.31272, 0.32903, 6504);
    const glm::dvec3 black =
        xyz_of_radiance(tabulate([](double nm) { return blackbody_radiance(4000, nm); }));
    CHECK(correlated_color_temperature(black).kelvin == doctest::Approx(4000).epsilon(1e-4));
    CHECK(std::abs(correlated_color_temperature(black).duv) < 1e-6);
    // Above the locus green, below it pink.
    CHECK(correlated_color_temperature(black * glm::dvec3(1, 1.05, 1)).duv > 0.005);
    CHECK(correlated_color_temperature(black * glm::dvec3(1, 0.95, 1)).duv < -0.005);
    // White of Rec.709 is D65.
    CHECK(chromaticity_xy(xyz_of_rgb({1, 1, 1})).x == doctest::Approx(0.31272).epsilon(1e-4));
    CHECK(chromaticity_uv(xyz_of_rgb({1, 1, 1})).y == doctest::Approx(0.4683).epsilon(1e-3));
}

TEST_CASE("light renders colours by the indices of CIE 15 and 13.3") {
    const auto rendering = [](const std::string& light) {
        return color_rendering(library_table("illuminant " + light, Outside::zero));
    };
    for (const char* reference : {"A", "D65"}) {
        CAPTURE(reference);
        const ColorRendering r = rendering(reference);
        CHECK(r.general == doctest::Approx(100).epsilon(1e-3));
        CHECK(r.each[8] == doctest::Approx(100).epsilon(2e-3));
        CHECK(r.off_reference < 5e-4);
    }
    // CIE 15:2004, rounded there; F4 and F8 are close to half a unit.
    const double general[] = {76, 64, 57, 51, 72, 59, 90, 95.5, 90, 81, 83, 83};
    for (int i = 0; i < 12; ++i) {
        CAPTURE(i + 1);
        CHECK(std::abs(rendering("F" + std::to_string(i + 1)).general - general[i]) < 0.55);
    }
    // As the Python package colour-science 0.4.7 has them from the same tables; its temperatures, by
    // Robertson's method, are off by up to 1 K.
    const double f4[] = {42.2, 69.9,   90.5, 38.0, 41.0, 53.8, 65.0,
                         11.5, -110.9, 31.5, 18.6, 25.1, 46.9, 94.3};
    const double f11[] = {98.2, 92.7, 51.1, 88.4, 87.2, 77.4, 88.6, 79.2, 24.9, 47.1, 72.5, 53.2, 97.1, 67.2};
    for (int i = 0; i < 14; ++i) {
        CAPTURE(i + 1);
        CHECK(std::abs(rendering("F4").each[i] - f4[i]) < 0.3);
        CHECK(std::abs(rendering("F11").each[i] - f11[i]) < 0.3);
    }
    // CIE daylight is its own reference: black body below 5000 K, daylight above.
    CHECK(color_rendering(cie_daylight(7500)).general == doctest::Approx(100).epsilon(1e-3));
    CHECK(color_rendering(cie_daylight(4500)).off_reference > 1e-3);
    // Sodium is far from all references.
    const SpectralTable sodium =
        tabulate([](double nm) { return std::exp(-0.5 * (nm - 589) * (nm - 589) / 4); });
    CHECK(color_rendering(sodium).off_reference > most_off_reference);
}

TEST_CASE("meters with spectra tell colour rendering, with intervals that hold the truth") {
    std::mt19937 random(3);
    const uint32_t bins = 94;
    const SpectralTable light = library_table("illuminant F11", Outside::zero);
    const auto measured = [&](const SpectralTable& spectrum, uint32_t bins, double noise) {
        Readings readings = noisy_readings({100, 100, 100, 100}, 2, 0, random);
        readings.spectral_bins = bins;
        std::normal_distribution<double> normal;
        for (uint32_t row_and_replicate = 0; row_and_replicate < 2 * replicates; ++row_and_replicate)
            for (uint32_t bin = 0; bin < bins; bin += 3) {
                glm::vec3 values(0);
                for (uint32_t i = 0; i < 3 && bin + i < bins; ++i) {
                    const double nm = first_nm + (bin + i + 0.5) * (last_nm - first_nm) / bins;
                    values[int(i)] = float(spectrum.at(nm) * (1 + noise * normal(random)));
                }
                add_exactly(readings.row_spectra.emplace_back(), values);
            }
        return figures_of(readings, {});
    };
    const double truth = figure(measured(light, bins, 0), "Ra").interval.value;
    CHECK(truth == doctest::Approx(82.9).epsilon(0.005));
    int held = 0, held_ninth = 0;
    const int cases = 150;
    const double truth_ninth = figure(measured(light, bins, 0), "R9").interval.value;
    for (int i = 0; i < cases; ++i) {
        const auto figures = measured(light, bins, 0.02);
        const Interval ra = figure(figures, "Ra").interval, ninth = figure(figures, "R9").interval;
        CHECK(ra.high - ra.low < 2);
        held += ra.low <= truth && truth <= ra.high;
        held_ninth += ninth.low <= truth_ninth && truth_ninth <= ninth.high;
    }
    CHECK(held > 0.9 * cases);
    CHECK(held < cases);
    CHECK(held_ninth > 0.9 * cases);

    const SpectralTable green = light * library_table("CIE test colour 11", Outside::hold);
    const auto refused = measured(green, bins, 0);
    CHECK(std::isnan(figure(refused, "Ra").interval.value));
    CHECK(figure(refused, "Ra").where.starts_with("out of range: 0.0"));
    for (const Figure& f : measured(light, 30, 0)) CHECK(f.name != "Ra");
}

TEST_CASE("tables for spreadsheets quote what they must") {
    CHECK(as_csv({{"a", "b"}, {"1,5", "say \"no\""}}) == "a,b\n\"1,5\",\"say \"\"no\"\"\"\n");
}
