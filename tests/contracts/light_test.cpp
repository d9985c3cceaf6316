// Every class of light, on the device: its sampler against its density and its radiance, its power against
// the light it sends, and its illuminance against closed forms. Classes come from the registry; one without a
// configuration here fails.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/contracts/light_configurations.h"
#include "tests/support/device_fixture.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double false_alarm = 1e-4;

// The sphere in cells of equal solid angle: 32 rows in y by 64 columns in azimuth.
constexpr uint32_t rows = 32, columns = 64;

glm::vec3 cell_direction(double row, double column) {
    const double y = 1 - 2 * row / rows, phi = 2 * pi * column / columns,
                 s = std::sqrt(std::max(0.0, 1 - y * y));
    return {float(s * std::sin(phi)), float(y), float(-s * std::cos(phi))};
}
uint32_t direction_cell(glm::vec3 d) {
    double phi = std::atan2(double(d.x), -double(d.z));
    if (phi < 0) phi += 2 * pi;
    const auto row = std::clamp(int((1 - d.y) / 2 * rows), 0, int(rows) - 1);
    return uint32_t(row) * columns + std::min(uint32_t(phi / (2 * pi) * columns), columns - 1);
}

}  // namespace

TEST_CASE("light: every registered class has a configuration to be tested with") {
    ClassRegistry registry(test_sources());
    for (const ClassInfo& info : registry.classes(Interface::light)) {
        CAPTURE(info.name);
        CHECK((info.name == "area" || !light_configurations(info.name).empty()));
    }
}

TEST_CASE("light: directions are sampled with the stated density, and bring the radiance that a ray meets") {
    ClassRegistry registry(test_sources());
    for (const ClassInfo& info : registry.classes(Interface::light))
        for (const LightConfiguration& c : light_configurations(info.name)) {
            CAPTURE(info.name);
            CAPTURE(c.label);
            LightProbe probe = make_light(info.name, c);
            const uint32_t count = 1 << 20;
            const auto samples = probe.sample(c.point, count, 5);
            if (samples[0].is_delta) {
                for (const ProbeSample& s : samples)  // pdf 0: the point is outside of a spot light's cone
                    if (s.pdf > 0) REQUIRE(s.pdf_towards == doctest::Approx(s.pdf).epsilon(1e-6));
                continue;
            }
            std::vector<double> observed(rows * columns + 1), expected(rows * columns + 1);
            double worst_pdf = 0, worst_radiance = 0, worst_length = 0;
            for (const ProbeSample& s : samples) {
                if (!(s.pdf > 0)) {
                    observed.back() += 1;
                    continue;
                }
                observed[direction_cell(s.direction)] += 1;
                worst_pdf = std::max(worst_pdf, std::abs(s.pdf_towards / double(s.pdf) - 1));
                worst_radiance = std::max(
                    worst_radiance, std::abs(luminance(s.radiance_towards) / luminance(s.radiance) - 1));
                worst_length = std::max(worst_length, std::abs(glm::length(glm::dvec3(s.direction)) - 1));
            }
            CHECK(worst_pdf < 2e-3);
            CHECK(worst_radiance < 2e-3);
            CHECK(worst_length < 1e-6);

            const uint32_t fine = 16;  // quadrature points along each side of a cell
            std::vector<glm::vec3> directions;
            for (uint32_t i = 0; i < rows * columns; ++i)
                for (uint32_t j = 0; j < fine * fine; ++j)
                    directions.push_back(cell_direction(i / columns + (j / fine + 0.5) / fine,
                                                        i % columns + (j % fine + 0.5) / fine));
            const auto towards = probe.evaluate(c.point, directions);
            double total = 0;
            for (size_t i = 0; i < directions.size(); ++i) {
                const double p = towards[i].pdf * (4 * pi / double(directions.size()));
                expected[i / (fine * fine)] += p * count;
                total += p;
            }
            CHECK(total == doctest::Approx(1).epsilon(1e-3));
            const ChiSquared chi = chi_squared_test(observed, expected);
            CAPTURE(chi.statistic);
            CAPTURE(chi.degrees);
            CHECK(chi.p_value > sidak_level(false_alarm, 8));
        }
}

TEST_CASE("light: a point light's illuminance is I cos / d²") {
    const LightConfiguration c = light_configurations("point")[0];
    LightProbe probe = make_light("point", c);
    for (glm::vec3 p : {glm::vec3(0, 0, 0), glm::vec3(1, 2, -3.001f), glm::vec3(1e4f, 0, 0)}) {
        const ProbeSample s = probe.sample(p, 1, 0)[0];
        const glm::dvec3 d = glm::dvec3(1, 2, -3) - glm::dvec3(p);
        const double e = 7 / glm::dot(d, d);
        CHECK(s.is_delta);
        CHECK(s.radiance.x / s.pdf == doctest::Approx(e).epsilon(1e-6));
        CHECK(s.radiance.z / s.pdf == doctest::Approx(0.25 * e).epsilon(1e-6));
        CHECK(s.distance == doctest::Approx(glm::length(d)).epsilon(1e-6));
        CHECK(glm::length(glm::dvec3(s.direction) - glm::normalize(d)) < 1e-6);
    }
    CHECK(probe.sample({1, 2, -3}, 1, 0)[0].pdf == 0.0f);  // at the light itself: no direction
    CHECK(probe.measure().power == doctest::Approx(4 * pi * 7 * luminance({1, 0.5f, 0.25f})).epsilon(1e-6));
}

TEST_CASE("light: a spot light falls off as KHR_lights_punctual recommends, and its power is its flux") {
    for (const LightConfiguration& c : light_configurations("spot")) {
        CAPTURE(c.label);
        LightProbe probe = make_light("spot", c);
        const double intensity = c.parameters.value("intensity", 1.0),
                     inner = c.parameters["inner_cone_angle"], outer = c.parameters["outer_cone_angle"];
        const glm::dvec3 axis(0.6, -0.8, 0), side(0.8, 0.6, 0), origin(1, 2, -3);
        const int steps = 2000;
        double flux = 0;
        std::vector<glm::vec3> points;
        for (int i = 0; i < steps; ++i) {
            const double angle = 1.25 * outer * (i + 0.5) / steps;
            points.push_back(glm::vec3(origin + 2.0 * (std::cos(angle) * axis + std::sin(angle) * side)));
        }
        const auto samples = probe.sample_at(points);
        for (int i = 0; i < steps; ++i) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(points[i]) - origin);
            const double angle = std::atan2(glm::length(glm::cross(axis, d)), glm::dot(axis, d));
            const double t = std::clamp(
                (std::cos(angle) - std::cos(outer)) / std::max(1e-12, std::cos(inner) - std::cos(outer)), 0.0,
                1.0);
            const double measured = samples[i].pdf > 0 ? samples[i].radiance.x : 0.0;
            if (c.label == "wide")
                REQUIRE(measured == doctest::Approx(intensity * t * t).epsilon(1e-4).scale(intensity));
            const double nominal = 1.25 * outer * (i + 0.5) / steps;
            flux += measured * 2 * pi * std::sin(nominal) * 1.25 * outer / steps;
        }
        // Points 2 m away are rounded to float: an angle of 0.001 is known to 1e-4 of itself.
        CHECK(probe.measure().power == doctest::Approx(flux).epsilon(c.label == "wide" ? 1e-4 : 2e-3));
    }
}

TEST_CASE("light: a directional light comes from +z of its node with its illuminance, whatever the scale") {
    LightProbe probe = make_light("directional", light_configurations("directional")[0]);
    const ProbeSample s = probe.sample({1, 1, 1}, 1, 0)[0];
    CHECK(glm::length(s.direction - glm::vec3(-0.6f, 0.8f, 0)) < 1e-6f);
    CHECK(s.radiance.y == 5.0f);
    CHECK(s.distance >= 1e30f);
    CHECK(probe.measure(2.0f).power == doctest::Approx(pi * 4 * 5).epsilon(1e-6));
    CHECK(is_at_infinity(probe.measure()));
}

TEST_CASE("light: under a constant environment the illuminance is pi times the radiance") {
    LightProbe probe = make_light("constant", light_configurations("constant")[0]);
    Moments e;
    for (const ProbeSample& s : probe.sample({}, 1 << 20, 3))
        e.add(s.radiance.y * std::max(0.0f, glm::dot(s.direction, glm::vec3(0.6f, 0, 0.8f))) / s.pdf);
    CHECK(z_test(e.mean, 2 * pi, e.standard_error(), 1e-5) > false_alarm);
    CHECK(probe.measure(3.0f).power == doctest::Approx(4 * pi * pi * 9 * luminance({1, 2, 3})).epsilon(1e-6));
}
