#include "host/lights/sun_position.h"

#include <chrono>
#include <cmath>
#include <numbers>
#include <regex>

namespace etendue {
namespace {

constexpr double degree = std::numbers::pi / 180;

double refraction(double elevation) {  // degrees, of an elevation without; none well below the horizon
    return elevation < -1 ? 0 : 1.02 / 60 / std::tan((elevation + 10.3 / (elevation + 5.11)) * degree);
}

}  // namespace

std::optional<double> days_since_2000(const std::string& moment) {
    static const std::regex format(
        R"((\d{4})-(\d\d)-(\d\d)T(\d\d):(\d\d)(?::(\d\d(?:\.\d{1,9})?))?(?:Z|([+-])(\d\d)(?::?(\d\d))?))");
    std::smatch part;
    if (!std::regex_match(moment, part, format)) return {};
    const auto number = [&](size_t i) { return part[i].matched ? std::stod(part[i].str()) : 0.0; };
    const std::chrono::year_month_day date{std::chrono::year(int(number(1))),
                                           std::chrono::month(unsigned(number(2))),
                                           std::chrono::day(unsigned(number(3)))};
    const bool is_moment = date.ok() && number(1) >= 1950 && number(1) <= 2050 && number(4) < 24 &&
                           number(5) < 60 && number(6) < 61 && number(8) < 24 && number(9) < 60;
    if (!is_moment) return {};
    const double zone = (part[7] == "-" ? -1 : 1) * (number(8) + number(9) / 60);
    const auto days = std::chrono::sys_days(date) -
                      std::chrono::sys_days(std::chrono::year(2000) / std::chrono::January / 1);
    return double(days.count()) - 0.5 + (number(4) + number(5) / 60 + number(6) / 3600 - zone) / 24;
}

glm::dvec3 sun_direction(double latitude, double longitude, double days) {
    // Michalsky's equations 2 to 10, degrees.
    const double mean_longitude = 280.460 + 0.9856474 * days;
    const double anomaly = (357.528 + 0.9856003 * days) * degree;
    const double ecliptic =
        (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * degree;
    const double obliquity = (23.439 - 4e-7 * days) * degree;
    const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
    const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
    const double hours = 24 * (days + 0.5 - std::floor(days + 0.5));  // of the day, UT
    const double sidereal = 6.697375 + 0.0657098242 * days + hours;
    const double hour_angle = (15 * sidereal + longitude) * degree - right_ascension;

    const double phi = latitude * degree;
    const double east = -std::cos(declination) * std::sin(hour_angle);
    const double north =
        std::sin(declination) * std::cos(phi) - std::cos(declination) * std::sin(phi) * std::cos(hour_angle);
    const double up =
        std::sin(declination) * std::sin(phi) + std::cos(declination) * std::cos(phi) * std::cos(hour_angle);
    const double across = std::hypot(east, north), elevation = std::atan2(up, across) / degree;
    const double seen = (elevation + refraction(elevation)) * degree;
    if (!(across > 1e-12)) return {0, up < 0 ? -1 : 1, 0};
    return {std::cos(seen) * east / across, std::sin(seen), -std::cos(seen) * north / across};
}

}  // namespace etendue
