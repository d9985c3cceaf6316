#include "host/scene/sky_record.h"

#include <cmath>
#include <numbers>

#include "host/error.h"
#include "host/lights/sun_position.h"
#include "host/scene/records.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

using nlohmann::json;

double number(const json& sun, const char* name, double most, const std::string& place) {
    const json& value = sun[name];
    if (!value.is_number() || !(std::abs(value.get<double>()) <= most))
        fail_input("{}/{}: {} is not allowed; allowed: a number in [-{}, {}]", place, name, value.dump(),
                   most, most);
    return value.get<double>();
}

}  // namespace

glm::vec3 read_sun(const json& value, const std::string& place) {
    if (value.is_null()) return glm::vec3(0);
    if (value.is_array() && value.size() == 3) {
        glm::dvec3 v(0);
        for (int i = 0; i < 3; ++i)
            if (value[size_t(i)].is_number()) v[i] = value[size_t(i)].get<double>();
        if (!(glm::length(v) > 0) || !(glm::length(v) < 1e30))
            fail_input("{}: {} is not allowed; allowed: a direction of 3 numbers", place, value.dump());
        return glm::vec3(glm::normalize(v));
    }
    if (!value.is_object())
        fail_input("{}: allowed: a direction [x, y, z], or {{\"latitude\", \"longitude\", \"time\"}}", place);
    for (const auto& [name, unused] : value.items())
        if (name != "latitude" && name != "longitude" && name != "time" && name != "north")
            fail_input("{}/{}: unknown; allowed: latitude, longitude, time, north", place, name);
    for (const char* name : {"latitude", "longitude", "time"})
        if (!value.contains(name))
            fail_input("{}: lacks {}; needed: latitude, longitude and time", place, name);
    const auto days =
        days_since_2000(value["time"].is_string() ? value["time"].get<std::string>() : std::string());
    if (!days)
        fail_input(
            "{}/time: {} is not allowed; allowed: a moment of 1950 to 2050 with its zone, as "
            "\"2026-06-21T14:00:00+02:00\"",
            place, value["time"].dump());
    const glm::dvec3 sun =
        sun_direction(number(value, "latitude", 90, place), number(value, "longitude", 180, place), *days);
    const double north = value.contains("north") ? number(value, "north", 2 * std::numbers::pi, place) : 0;
    return glm::vec3(glm::dvec3(std::cos(north) * sun.x + std::sin(north) * sun.z, sun.y,
                                std::cos(north) * sun.z - std::sin(north) * sun.x));
}

SkyParameters sky_parameters(const ClassInfo& info, const std::vector<std::byte>& record,
                             const std::string& place) {
    SkyParameters p;
    p.type = record_member<uint32_t>(info, record, "type");
    p.diffuse = record_member<float>(info, record, "diffuse");
    p.direct = record_member<float>(info, record, "direct");
    p.ground = record_member<float>(info, record, "ground");
    const auto color = [&](const char* name) {
        const double y = luminance(glm::dvec3(record_member<SpectrumRef>(info, record, name).rgb));
        if (!(y > 0)) fail_input("{}/{}: is black; allowed: what has a colour", place, name);
        return y;
    };
    p.sky_color = color("color"), p.sun_color = color("sun_color");
    const glm::dvec3 sun = record_member<glm::vec3>(info, record, "sun");
    if (p.direct > 0 || sky_coefficients(p.type).knows_sun()) {
        const std::string who =
            p.direct > 0 ? std::string("light of the sun (direct)") : fmt::format("a sky of type {}", p.type);
        if (glm::length(sun) == 0) fail_input("{}: lacks sun, which {} needs", place, who);
        if (!(sun.y >= 0))
            fail_input("{}/sun: is {:.3g}° below the horizon; allowed for {}: above", place,
                       -std::asin(sun.y) * 180 / std::numbers::pi, who);
    }
    if (glm::length(sun) > 0) p.sun = glm::normalize(sun);
    return p;
}

}  // namespace etendue
