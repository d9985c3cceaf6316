// Where the sun stands.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace etendue {

// Days since 2000-01-01T12:00Z of an ISO 8601 moment with its zone, "2026-06-21T14:30:00+02:00"; seconds and
// their decimals may be left out, "Z" is UTC. Nothing where it is none, or not between 1950 and 2050.
std::optional<double> days_since_2000(const std::string& moment);

// Unit vector towards the middle of the sun as it is seen, in the frame of a scene: -z is north, +x east, +y
// up. Degrees, north and east positive. Off by less than 0.01° between 1950 and 2050 (Michalsky 1988, "The
// Astronomical Almanac's algorithm for approximate solar position (1950-2050)", Solar Energy 40(3), 227-235),
// and by what the air refracts otherwise than Saemundsson 1986 ("Atmospheric refraction", Sky & Telescope 72,
// 70) says for 1010 hPa and 10 °C: 0.57° at the horizon.
glm::dvec3 sun_direction(double latitude, double longitude, double days);

}  // namespace etendue
