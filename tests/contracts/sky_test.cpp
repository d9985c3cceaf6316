// The CIE general sky and its sun: luminances on the device against those of ISO 15469, illuminances against
// what was asked for, and the sun's disk against its solid angle.
#include <cmath>
#include <numbers>

#include "host/lights/sky.h"
#include "tests/support/device_fixture.h"
#include "tests/support/light_probe.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi;
const glm::dvec3 sun = glm::normalize(glm::dvec3(0.5, 0.6, -0.7));

LightProbe probe_of(nlohmann::json parameters) { return LightProbe("sky", parameters, glm::dmat4(1.0), {}); }

// Illuminance of a plane by samples of the light.
Moments illuminance(LightProbe& probe, const glm::dvec3& normal, uint32_t seed) {
    Moments e;
    for (const ProbeSample& s : probe.sample({}, 1 << 20, seed))
        e.add(s.pdf > 0 ? s.radiance.y * std::max(0.0, glm::dot(glm::dvec3(s.direction), normal)) / s.pdf
                        : 0.0);
    return e;
}

}  // namespace

TEST_CASE("sky: all fifteen have the luminances of the standard, and the illuminance asked for") {
    std::vector<glm::vec3> directions;
    for (double y : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999})
        for (int i = 0; i < 24; ++i) {
            const double across = std::sqrt(1 - y * y), azimuth = 2 * pi * (i + 0.5) / 24;
            directions.push_back(
                {float(across * std::cos(azimuth)), float(y), float(across * std::sin(azimuth))});
        }
    directions.push_back({0, 1, 0});
    for (uint32_t type = 1; type <= 15; ++type) {
        CAPTURE(type);
        LightProbe probe =
            probe_of({{"type", type}, {"diffuse", 1000}, {"ground", 0}, {"sun", {sun.x, sun.y, sun.z}}});
        const auto values = probe.evaluate({}, directions);
        const double zenith = values.back().radiance.y;
        for (size_t i = 0; i < directions.size(); ++i)
            REQUIRE(values[i].radiance.y / zenith ==
                    doctest::Approx(relative_luminance(sky_coefficients(type), directions[i], sun))
                        .epsilon(2e-5));
        const Moments e = illuminance(probe, {0, 1, 0}, type);
        CHECK(z_test(e.mean, 1000, e.standard_error(), 1e-4) > 1e-4);
        // Directions are drawn nearly in proportion to luminance.
        CHECK(e.standard_error() < 1.0);
    }
}

TEST_CASE(
    "sky: type 5 is even, type 1 three times as bright at the zenith, and the ground mirrors what it gets") {
    LightProbe even = probe_of({{"type", 5}, {"diffuse", 1000 * pi}, {"ground", 0.3}});
    for (const ProbeValue& v : even.evaluate({}, {{0, 1, 0}, {0.8f, 0.6f, 0}, {0, 0.001f, 1}}))
        CHECK(v.radiance.x == doctest::Approx(1000).epsilon(1e-5));
    CHECK(even.evaluate({}, {{0.6f, -0.8f, 0}})[0].radiance.x == doctest::Approx(300).epsilon(1e-5));
    LightProbe overcast = probe_of({{"type", 1}, {"diffuse", 1000}});
    const auto v = overcast.evaluate({}, {{0, 1, 0}, {1, 1e-4f, 0}});
    CHECK(v[0].radiance.x / v[1].radiance.x == doctest::Approx(1 + 4 * std::exp(-0.7)).epsilon(1e-4));
    // Over all directions: pi R² times the sky's 2 pi L and the ground's.
    CHECK(even.measure(2.0f).power == doctest::Approx(pi * 4 * 2 * pi * 1300).epsilon(1e-4));
}

TEST_CASE(
    "sky: the sun is a disk of 0.53°, drawn by its share of the flux, and lights by what was asked for") {
    const nlohmann::json parameters = {{"type", 12},
                                       {"diffuse", 20000},
                                       {"direct", 60000},
                                       {"ground", 0.1},
                                       {"sun", {sun.x, sun.y, sun.z}},
                                       {"sun_color", {3, 2, 1}},
                                       {"color", {0.5, 1, 2}}};
    LightProbe probe = probe_of(parameters);
    const double radius = 0.265 * pi / 180, solid_angle = 2 * pi * (1 - std::cos(radius));
    const uint32_t count = 1 << 20, rings = 8, sectors = 8;
    std::vector<double> observed(rings * sectors), expected(rings * sectors);
    const glm::dvec3 x = glm::normalize(glm::cross(sun, glm::dvec3(0, 1, 0))), y = glm::cross(sun, x);
    double in_disk = 0, lit = 0, worst = 0;
    for (const ProbeSample& s : probe.sample({}, count, 7)) {
        const glm::dvec3 d = s.direction;
        worst = std::max(worst, std::abs(s.pdf_towards / double(s.pdf) - 1));
        const double around = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * pi) + 0.5;
        const double part = glm::dot(d - sun, d - sun) / (4 * std::pow(std::sin(radius / 2), 2));
        if (part > 1) continue;
        ++in_disk;
        lit += s.radiance.y > 1e7;
        observed[std::min(uint32_t(part * rings), rings - 1) * sectors +
                 std::min(uint32_t(around * sectors), sectors - 1)] += 1;
    }
    CHECK(worst < 2e-3);
    CHECK(lit == doctest::Approx(in_disk).epsilon(1e-4));
    for (double& cell : expected) cell = in_disk / (rings * sectors);
    CHECK(chi_squared_test(observed, expected).p_value > 1e-4);
    const double power = probe.measure(1.0f).power / pi;
    const double share = 60000 / power;
    CHECK(z_test(in_disk / count, share, std::sqrt(share * (1 - share) / count) + 2e-5, 1e-4) > 1e-4);

    // Luminance of the disk, by E = L pi sin² of its radius.
    const auto at = probe.evaluate({}, {glm::vec3(sun), glm::vec3(glm::normalize(sun + 1.02 * radius * x))});
    const auto y_of = [](const glm::vec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; };
    CHECK(y_of(at[0].radiance) - y_of(at[1].radiance) ==
          doctest::Approx(60000 / (pi * std::pow(std::sin(radius), 2))).epsilon(1e-3));
    CHECK(at[0].pdf - at[1].pdf == doctest::Approx(share / solid_angle).epsilon(1e-3));
    // Of luminance, whatever the colours.
    for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), sun, glm::dvec3(0, -1, 0)}) {
        Moments e;
        for (const ProbeSample& s : probe.sample({}, count, 8))
            e.add(s.pdf > 0
                      ? y_of(s.radiance) * std::max(0.0, glm::dot(glm::dvec3(s.direction), normal)) / s.pdf
                      : 0.0);
        const double horizontal = 20000 + 60000 * sun.y;
        if (normal.y == 1) CHECK(z_test(e.mean, horizontal, e.standard_error(), 1e-4) > 1e-4);
        if (normal.y == -1) CHECK(z_test(e.mean, 0.1 * horizontal, e.standard_error(), 1e-4) > 1e-4);
        if (normal == sun) CHECK(e.mean > 60000);
        CHECK(e.standard_error() < 5e-3 * e.mean);
    }
}
