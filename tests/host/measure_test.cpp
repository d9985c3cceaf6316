// Figures of meters and their intervals, and chromaticities, without a device.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "host/measure/figures.h"
#include "host/spectra/chromaticity.h"
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

TEST_CASE("tables for spreadsheets quote what they must") {
    CHECK(as_csv({{"a", "b"}, {"1,5", "say \"no\""}}) == "a,b\n\"1,5\",\"say \"\"no\"\"\"\n");
}
