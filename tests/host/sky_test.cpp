// Where the sun stands, and what a scene may say of its sky.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/error.h"
#include "host/lights/sky.h"
#include "host/lights/sun_position.h"
#include "host/scene/sky_record.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Place {
    double elevation, azimuth;  // degrees; azimuth from north to east
};
Place place_of(const glm::dvec3& sun) {
    double azimuth = std::atan2(sun.x, -sun.z) / degree;
    return {std::asin(sun.y) / degree, azimuth < 0 ? azimuth + 360 : azimuth};
}

std::string refusal(const json& sun) {
    try {
        read_sun(sun, "here/sun");
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_CASE("moments are read with their zones") {
    CHECK(days_since_2000("2000-01-01T12:00:00Z") == 0.0);
    CHECK(days_since_2000("2000-01-01T14:30+02:30") == 0.0);
    CHECK(days_since_2000("2000-01-01T00:00:00-12") == 0.0);
    CHECK(days_since_2000("2000-03-01T00:00:36.5Z").value() ==
          doctest::Approx(59.5 + 36.5 / 86400).epsilon(1e-12));
    CHECK(days_since_2000("1999-12-31T12:00:00Z") == -1.0);
    for (const char* bad :
         {"", "noon", "2026-06-21", "2026-06-21T12:00:00", "2026-02-30T12:00:00Z", "2026-06-21T24:00:00Z",
          "2026-06-21T12:60:00Z", "2026-06-21 12:00:00Z", "1949-06-21T12:00:00Z", "2026-06-21T12:00:00+2"}) {
        CAPTURE(bad);
        CHECK(!days_since_2000(bad));
    }
}

// Solar Position Algorithm of NREL (Reda & Andreas 2004), the first line the example of its report without
// refraction; here as computed by pvlib (spa_python, 1010 hPa, 10 °C).
TEST_CASE("the sun stands where the algorithm of NREL has it, to 0.01°") {
    struct Case {
        const char* moment;
        double latitude, longitude, elevation, azimuth;
    };
    const Case cases[] = {{"2003-10-17T12:30:30-07:00", 39.742476, -105.1786, 39.892234, 194.340241},
                          {"2026-06-21T12:00:00+02:00", 48.137, 11.575, 61.123159, 142.088451},
                          {"2026-12-21T09:30:00+09:00", 35.68, 139.77, 23.538305, 147.794742},
                          {"2026-03-20T18:00:00+00:00", -33.87, -70.65, 52.320097, 330.522761},
                          {"1998-01-05T15:45:20+10:00", -37.81, 144.96, 44.828252, 274.842324},
                          {"2045-08-12T23:00:00Z", 69.65, 18.96, -5.719909, 2.653321}};
    for (const Case& c : cases) {
        CAPTURE(c.moment);
        const glm::dvec3 sun = sun_direction(c.latitude, c.longitude, days_since_2000(c.moment).value());
        CHECK(glm::length(sun) == doctest::Approx(1));
        const Place place = place_of(sun);
        CHECK(std::abs(place.elevation - c.elevation) < 0.01);
        CHECK(std::abs(place.azimuth - c.azimuth) * std::cos(c.elevation * degree) < 0.01);
    }
}

TEST_CASE("scenes say where the sun is by direction, or by place and time") {
    CHECK(glm::length(read_sun({0, 3, 4}, "") - glm::vec3(0, 0.6f, 0.8f)) < 1e-6f);
    CHECK(read_sun(nullptr, "") == glm::vec3(0));
    json golden = {{"latitude", 39.742476}, {"longitude", -105.1786}, {"time", "2003-10-17T12:30:30-07:00"}};
    CHECK(std::abs(place_of(read_sun(golden, "")).azimuth - 194.34) < 0.02);
    // North turns to -x, and all directions with it.
    golden["north"] = 0.5;
    CHECK(std::abs(place_of(read_sun(golden, "")).azimuth - (194.34 - 0.5 / degree)) < 0.02);
    CHECK(refusal({{"latitude", 48}, {"direction", {0, 1, 0}}}) ==
          "here/sun/direction: unknown; allowed: latitude, longitude, time, north");
    CHECK(refusal({{"latitude", 48}, {"longitude", 11}}).find("lacks time") != std::string::npos);
    CHECK(
        refusal({{"latitude", 91}, {"longitude", 11}, {"time", "2026-06-21T12:00:00Z"}}).find("[-90, 90]") !=
        std::string::npos);
    CHECK(refusal({{"latitude", 48}, {"longitude", 11}, {"time", "2026-06-21T12:00:00"}})
              .find("with its zone") != std::string::npos);
    CHECK(refusal({0, 0, 0}).find("a direction of 3 numbers") != std::string::npos);
    CHECK(refusal("noon").find("here/sun: allowed") != std::string::npos);
}

TEST_CASE("whatever stands for the sun is refused in a line, or is a direction") {
    std::mt19937 random(1);
    const std::string text =
        R"({"latitude": 39.7, "longitude": -105.2, "time": "2003-10-17T12:30:30-07:00", "north": 0.5})";
    int read = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string damaged = text;
        for (uint32_t n = 1 + random() % 3; n > 0; --n) {
            const size_t at = random() % damaged.size();
            if (random() % 3 == 0)
                damaged.erase(at, 1 + random() % 4);
            else
                damaged[at] = R"(0123456789-+.:,TZ"e[]{}x)"[random() % 24];
        }
        const json value = json::parse(damaged, nullptr, false);
        if (value.is_discarded() || value.is_null()) continue;
        try {
            const glm::vec3 sun = read_sun(value, "sun");
            CHECK(std::abs(glm::length(sun) - 1) < 1e-5);
            ++read;
        } catch (const Error& e) {
            CHECK(std::string(e.what()).find('\n') == std::string::npos);
        }
    }
    CHECK(read > 500);
}

// Of the luminance of the zenith. Type 1 by hand: (1 + 4 exp(-0.7 / 0.5)) / (1 + 4 exp(-0.7)) at 60° from it.
// Type 12 with the sun at 60° elevation, in that of the sun and opposite of it at 45°.
TEST_CASE("skies have the luminances of ISO 15469") {
    const glm::dvec3 sun(0.5, std::sqrt(0.75), 0), at_60(std::sqrt(0.75), 0.5, 0);
    CHECK(relative_luminance(sky_coefficients(1), at_60, sun) ==
          doctest::Approx(1.986388 / 2.986341).epsilon(1e-5));
    CHECK(relative_luminance(sky_coefficients(5), at_60, sun) == doctest::Approx(1));
    const auto clear = [](double from_zenith, double from_sun) {
        const double pi = std::numbers::pi;
        return (1 - std::exp(-0.32 / std::cos(from_zenith * degree))) *
               (1 + 10 * (std::exp(-3 * from_sun * degree) - std::exp(-1.5 * pi)) +
                0.45 * std::pow(std::cos(from_sun * degree), 2));
    };
    CHECK(relative_luminance(sky_coefficients(12), sun, sun) ==
          doctest::Approx(clear(30, 0) / clear(0, 30)).epsilon(1e-9));
    const glm::dvec3 opposite(-std::sqrt(0.5), std::sqrt(0.5), 0);
    CHECK(relative_luminance(sky_coefficients(12), opposite, sun) ==
          doctest::Approx(clear(45, 75) / clear(0, 30)).epsilon(1e-9));
    // Gradations and indicatrices of the standard: six of each.
    const double a[] = {4, 4, 1.1, 1.1, 0, 0, 0, 0, -1, -1, -1, -1, -1, -1, -1};
    const double b[] = {0.7, 0.7, 0.8, 0.8, 1, 1, 1, 1, 0.55, 0.55, 0.55, 0.32, 0.32, 0.15, 0.15};
    const double c[] = {0, 2, 0, 2, 0, 2, 5, 10, 2, 5, 10, 10, 16, 16, 24};
    for (uint32_t type = 1; type <= 15; ++type) {
        const SkyCoefficients& s = sky_coefficients(type);
        CHECK(s.a == a[type - 1]);
        CHECK(s.b == -b[type - 1]);
        CHECK(s.c == c[type - 1]);
        CHECK(s.knows_sun() == (s.c > 0));
        CHECK(s.d == (s.c == 0 ? -1.0 : s.c == 2 ? -1.5 : s.c == 5 ? -2.5 : s.c == 24 ? -2.8 : -3.0));
        CHECK(s.e == (s.c == 0 ? 0.0 : s.c == 2 || s.c == 24 ? 0.15 : s.c == 10 ? 0.45 : 0.30));
    }
}
