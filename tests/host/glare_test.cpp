// Glare: Guth's position index and the unified glare rating, of an eye before which all luminances are known.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "host/measure/glare.h"

using namespace etendue;

namespace {

const glm::dvec3 sight(0, 0, -1), up(0, 1, 0);

// H, T and R of CIE 117:1995, figure 3: above the line of sight, beside it, along it.
double index_at(double h, double t) {
    return position_index(glm::normalize(glm::dvec3(t, h, -1)), sight, up);
}

// Half a sphere before an eye that looks along -z, in rows of equal solid angle, as a luminance meter has it.
Meter half_sphere(uint32_t columns, uint32_t rows) {
    Meter meter{"eye", "cd/m²", columns, rows, false, false, {}};
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const double z = 1 - (row + 0.5) / rows, r = std::sqrt(1 - z * z);
            const double turn = 2 * glm::pi<double>() * (column + 0.5) / columns;
            meter.places.push_back({glm::vec3(0), -glm::dvec3(r * std::cos(turn), r * std::sin(turn), -z),
                                    float(2 * glm::pi<double>() / (columns * rows))});
        }
    return meter;
}

}  // namespace

TEST_CASE("Guth's index is that of CIE 117's table") {
    // Table 1, T/R = 0: H/R = 0 to 1.4.
    const double straight[] = {1.00, 1.26, 1.53, 1.90, 2.35, 2.86, 3.50, 4.20, 5.00, 6.00, 7.00};
    for (int h = 0; h <= 10; ++h) CHECK(index_at(0.1 * h, 0) == doctest::Approx(straight[h]).epsilon(0.035));
    CHECK(index_at(0.5, 0.5) == doctest::Approx(index_at(0.5, -0.5)));
    CHECK(index_at(-0.3, 0) == doctest::Approx(1.24));
    CHECK(index_at(-1, 0) == doctest::Approx(2.2));
    CHECK(index_at(20, 0) == 16);
}

TEST_CASE("UGR of a source before an even background, and its interval") {
    const Meter meter = half_sphere(360, 180);
    const glm::dvec3 lamp = glm::normalize(glm::dvec3(0.2, 0.5, -1));
    const double half_angle = 0.1, lamp_luminance = 5000, background = 40;
    std::vector<double> truth;
    for (const PixelPlace& place : meter.places)
        truth.push_back(glm::dot(-glm::dvec3(place.direction), lamp) > std::cos(half_angle) ? lamp_luminance
                                                                                            : background);
    const double solid_angle = 2 * glm::pi<double>() * (1 - std::cos(half_angle));
    const double hidden = solid_angle * glm::dot(lamp, sight);  // of the background, times cos
    const double behind = background * (1 - hidden / glm::pi<double>());
    const double expected = 8 * std::log10(0.25 / behind * lamp_luminance * lamp_luminance * solid_angle /
                                           std::pow(position_index(lamp, sight, up), 2));
    int held = 0;
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int run = 0; run < 20; ++run) {
        std::vector<std::vector<double>> values(replicates);
        for (auto& replicate : values)
            for (double x : truth) replicate.push_back(x * (1 + 0.5 * normal(random)));
        const auto figures = glare_figures(meter, values, 500);
        REQUIRE(figures.size() == 3);
        CHECK(figures[0].interval.value ==
              doctest::Approx(glm::pi<double>() * behind + lamp_luminance * hidden).epsilon(0.01));
        CHECK(figures[1].interval.value == doctest::Approx(behind).epsilon(0.01));
        CHECK(figures[2].interval.value == doctest::Approx(expected).epsilon(0.005));
        // Pixels at the rim of the lamp and the spread of the index over it move UGR by a few hundredths.
        held += figures[2].interval.low - 0.05 < expected && expected < figures[2].interval.high + 0.05;
    }
    CHECK(held >= 17);
    CHECK(std::isnan(glare_figures(meter, {truth, truth}, 1e5)[2].interval.value));
    CHECK(glare_figures(half_sphere(36, 18), {truth, truth}, 500).empty());
}
