// Degrees and angles of polarization, and the layers of an image that tell them.
#include "host/image/polarization.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace etendue;

TEST_CASE("degrees and angles follow from Stokes vectors") {
    const auto check = [](const glm::dvec4& stokes, double linear, double degrees, double circular) {
        const PolarizationState s = polarization_state(stokes);
        CAPTURE(stokes[1]);
        CAPTURE(stokes[2]);
        CHECK(s.linear == doctest::Approx(linear));
        CHECK(double(s.angle) * 180 / std::numbers::pi == doctest::Approx(degrees));
        CHECK(s.circular == doctest::Approx(circular));
    };
    check({1, 1, 0, 0}, 1, 0, 0);
    check({2, 0, 1, 0}, 0.5, 45, 0);
    check({1, -0.5, 0, 0}, 0.5, 90, 0);
    check({4, 0, -2, 2}, 0.5, 135, 0.5);
    check({1, 0, 0, -1}, 0, 0, -1);
    check({1, 0.3, 0.3 * std::sqrt(3.0), 0}, 0.6, 30, 0);
    check({0, 0, 0, 0}, 0, 0, 0);
}

TEST_CASE("an image with S1 to S3 gets layers of degree and angle, of luminances") {
    Image image{.width = 2, .height = 1};
    add_channels(image, {"R", "G", "B"}, std::vector<float>{1, 1, 1, 0, 2, 0}, 3);
    CHECK(!has_stokes(image));
    add_channels(image, {"S1.R", "S1.G", "S1.B"}, std::vector<float>{0, 0, 0, 5, 1, 0}, 3);
    add_channels(image, {"S2.R", "S2.G", "S2.B"}, std::vector<float>{0.5f, 0.5f, 0.5f, 0, 0, 0}, 3);
    add_channels(image, {"S3.R", "S3.G", "S3.B"}, std::vector<float>{0.2f, 0.2f, 0.2f, 0, 0, 0}, 3);
    REQUIRE(has_stokes(image));
    CHECK(stokes_vectors(image)[0][2] == doctest::Approx(0.5));
    CHECK(stokes_vectors(image)[1][1] == doctest::Approx(5 * 0.2126 + 0.7152));
    add_polarization(image);
    const auto value = [&](const char* name, size_t pixel) {
        return plane(image, size_t(find_channel(image, name)))[pixel];
    };
    CHECK(value("polarization.DoLP", 0) == doctest::Approx(0.5));
    CHECK(value("polarization.AoLP", 0) == doctest::Approx(std::numbers::pi / 4));
    CHECK(value("polarization.DoCP", 0) == doctest::Approx(0.2));
}

TEST_CASE("false colours: an angle has the same after half a turn, degrees grow brighter") {
    for (double a : {0.0, 0.4, 1.2}) {
        const glm::vec3 x = angle_color(a), y = angle_color(a + std::numbers::pi);
        for (int c = 0; c < 3; ++c) CHECK(std::fabs(x[c] - y[c]) < 1e-5f);
        CHECK(glm::length(x - angle_color(a + 0.8)) > 0.2f);
    }
    double before = -1;
    for (double d = 0; d <= 1; d += 0.1) {
        const glm::vec3 c = degree_color(d);
        CHECK(double(c.x + c.y) > before);
        before = double(c.x + c.y);
    }
    CHECK(signed_degree_color(1).x > signed_degree_color(-1).x);
    CHECK(signed_degree_color(-1).z > signed_degree_color(1).z);
}
