// Environment images, on the device: radiance against the definition in double precision, orientation,
// sampling, what is no radiance.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "host/error.h"
#include "host/lights/environment_map.h"
#include "tests/contracts/light_configurations.h"
#include "tests/support/device_fixture.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double false_alarm = 1e-4;

// The image's radiance by its definition, in double precision: the azimuth runs from -z to +x, bilinear in it
// and in the cosine of the polar angle, constant between the outermost row centres and the poles.
glm::dvec3 image_reference(const ImageDescription& image, double rotation, const glm::dvec3& d) {
    const auto texel = [&](int x, int y) {
        x = (x % int(image.width) + int(image.width)) % int(image.width);
        y = std::clamp(y, 0, int(image.height) - 1);
        const float* p = &image.rgba32f[(size_t(y) * image.width + x) * 4];
        return glm::dvec3(p[0], p[1], p[2]);
    };
    const double u = (std::atan2(d.x, 0.0 - d.z) + rotation) / (2 * pi) + 0.5;
    const double x = (u - std::floor(u)) * image.width - 0.5;
    const auto row_cos = [&](int y) {
        return y < 0 ? 1.0 : y >= int(image.height) ? -1.0 : std::cos(pi * (y + 0.5) / image.height);
    };
    int y = -1;
    while (y + 1 < int(image.height) && d.y <= row_cos(y + 1)) ++y;
    const double t = (row_cos(y) - d.y) / (row_cos(y) - row_cos(y + 1));
    const int left = int(std::floor(x));
    const double s = x - left;
    return glm::mix(glm::mix(texel(left, y), texel(left + 1, y), s),
                    glm::mix(texel(left, y + 1), texel(left + 1, y + 1), s), t);
}

}  // namespace

TEST_CASE("light: an environment image shows its definition's radiance in every direction") {
    for (const LightConfiguration& c : light_configurations("image")) {
        CAPTURE(c.label);
        LightProbe probe = make_light("image", c);
        const double scale = c.parameters.value("scale", 1.0), rotation = c.parameters.value("rotation", 0.0);
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        std::vector<glm::vec3> directions = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1},
                                             {0, 0, 1}, {1, 0, 0},  {-1, 0, 0}};
        for (double tiny : {1e-3, 1e-5, 1e-8})
            for (double y : {1.0, -1.0})
                directions.push_back(glm::vec3(glm::normalize(glm::dvec3(tiny, y, 0.5 * tiny))));
        while (directions.size() < 50000)
            directions.push_back(
                glm::vec3(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)))));
        const auto values = probe.evaluate({}, directions);
        double worst = 0;
        glm::vec3 where(0);
        for (size_t i = 0; i < directions.size(); ++i) {
            const glm::dvec3 reference =
                scale * image_reference(c.image, rotation, glm::normalize(glm::dvec3(directions[i])));
            const double error = glm::length(glm::dvec3(values[i].radiance) - reference) / (scale * 20);
            if (error > worst) worst = error, where = directions[i];
        }
        CAPTURE(where.x);
        CAPTURE(where.y);
        CAPTURE(where.z);
        CHECK(worst < 3e-5);
    }
}

TEST_CASE("light: the centre of an environment image lies along -z, its right towards +x, its top row up") {
    const auto brightest = [](uint32_t column, uint32_t row, double rotation) {
        ImageDescription image;
        image.name = "one texel";
        image.width = 64, image.height = 32;
        image.rgba32f.assign(64 * 32 * 4, 0.0f);
        for (int c = 0; c < 3; ++c) image.rgba32f[(row * 64 + column) * 4 + c] = 1;
        LightProbe probe =
            make_light("image", {"", {{"file", "f"}, {"rotation", rotation}}, glm::dmat4(1.0), image, {}});
        glm::vec3 mean(0);
        for (const ProbeSample& s : probe.sample({}, 4096, 1)) mean += s.direction;
        return glm::normalize(mean);
    };
    const double tolerance = 0.08;  // half a texel is 0.05 rad
    CHECK(glm::length(brightest(32, 16, 0) - glm::vec3(0, 0, -1)) < tolerance);
    CHECK(glm::length(brightest(48, 16, 0) - glm::vec3(1, 0, 0)) < tolerance);
    CHECK(glm::length(brightest(0, 16, 0) - glm::vec3(0, 0, 1)) < tolerance);
    CHECK(glm::length(brightest(32, 0, 0) - glm::vec3(0, 1, 0)) < tolerance);
    CHECK(glm::length(brightest(32, 31, 0) - glm::vec3(0, -1, 0)) < tolerance);
    // A quarter turn about +y takes -z to -x.
    CHECK(glm::length(brightest(32, 16, pi / 2) - glm::vec3(-1, 0, 0)) < tolerance);
}

TEST_CASE("light: illuminance and power of an environment image are those of quadrature") {
    for (const LightConfiguration& c : light_configurations("image")) {
        CAPTURE(c.label);
        LightProbe probe = make_light("image", c);
        const double scale = c.parameters.value("scale", 1.0), rotation = c.parameters.value("rotation", 0.0);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.5, -0.7));
        double illuminance = 0, integral = 0;
        const int n = 800;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2 * n; ++j) {
                const double y = 1 - 2 * (i + 0.5) / n, phi = pi * (j + 0.5) / n, s = std::sqrt(1 - y * y);
                const glm::dvec3 d(s * std::sin(phi), y, -s * std::cos(phi));
                const double l = scale * luminance(glm::vec3(image_reference(c.image, rotation, d)));
                integral += l * 4 * pi / (2.0 * n * n);
                illuminance += l * std::max(0.0, glm::dot(d, normal)) * 4 * pi / (2.0 * n * n);
            }
        Moments e;
        for (const ProbeSample& s : probe.sample({}, 1 << 20, 3))
            if (s.pdf > 0)
                e.add(luminance(s.radiance) * std::max(0.0, glm::dot(glm::dvec3(s.direction), normal)) /
                      s.pdf);
            else
                e.add(0);
        CHECK(z_test(e.mean, illuminance, e.standard_error(), 1e-4 * illuminance) > false_alarm);
        CHECK(probe.measure(2.0f).power == doctest::Approx(pi * 4 * integral).epsilon(1e-4));
    }
}

TEST_CASE("light: a sun ten million times brighter than the sky leaves the sky's share right") {
    ImageDescription image;
    image.name = "sun and sky";
    image.width = 1024, image.height = 512;
    image.rgba32f.assign(1024 * 512 * 4, 1.0f);
    for (int c = 0; c < 3; ++c) image.rgba32f[(100 * 1024 + 300) * 4 + c] = 1e7f;
    LightProbe probe = make_light("image", {"", {{"file", "f"}}, glm::dmat4(1.0), image, {}});
    const double integral = probe.measure(1.0f).power / pi;
    // The lower half holds 2 pi of the sky.
    const uint32_t count = 1 << 23;
    double below = 0;
    for (uint32_t seed = 0; seed < 8; ++seed)
        for (const ProbeSample& s : probe.sample({}, count / 8, seed)) below += s.direction.y < 0;
    MESSAGE(below, " of ", count, " samples go to the sky below the horizon");
    const double expected = 2 * pi / integral * count;
    CHECK(z_test(below, expected, std::sqrt(expected), 1e-3 * expected) > false_alarm);
}

TEST_CASE("light: texels that are no radiance are named by column and row") {
    for (float bad :
         {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        ImageDescription image = probe_image(8, 4);
        image.rgba32f[(2 * 8 + 5) * 4 + 1] = bad;
        CHECK_THROWS_WITH_AS(
            build_environment_map(image),
            fmt::format(
                "probe: the texel in column 5, row 2 of this environment image is {}; radiance is a finite "
                "number, at least 0",
                bad)
                .c_str(),
            Error);
    }
    CHECK_THROWS_AS(build_environment_map(ImageDescription{}), Error);
}

TEST_CASE("light: 8-bit environment images are taken as sRGB") {
    ImageDescription image;
    image.name = "grey";
    image.width = image.height = 2;
    image.rgba8.assign(16, 188);  // 0.5029 in linear light
    LightProbe probe = make_light("image", {"", {{"file", "f"}}, glm::dmat4(1.0), image, {}});
    CHECK(probe.evaluate({}, {{0.6f, 0, 0.8f}})[0].radiance.y == doctest::Approx(0.5029).epsilon(1e-3));
}

TEST_CASE("light: a black environment image sends nothing") {
    ImageDescription image = probe_image(8, 4);
    for (float& v : image.rgba32f) v = 0;
    LightProbe probe = make_light("image", {"", {{"file", "f"}}, glm::dmat4(1.0), image, {}});
    CHECK(probe.sample({}, 1, 0)[0].pdf == 0.0f);
    CHECK(probe.measure().power == 0.0f);
    CHECK(probe.evaluate({}, {{0, 0, 1}})[0].pdf == 0.0f);
}
