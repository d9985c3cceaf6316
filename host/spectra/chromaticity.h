// Chromaticities of the CIE 1931 observer, and the temperature of the black body that looks most alike.
#pragma once
#include <glm/glm.hpp>

namespace etendue {

glm::dvec2 chromaticity_xy(const glm::dvec3& xyz);
glm::dvec2 chromaticity_uv(const glm::dvec3& xyz);  // u', v' of CIE 1976
glm::dvec2 uv_1960(const glm::dvec3& xyz);          // u, v of CIE 1960

// The nearest point of the Planckian locus in CIE 1960 (CIE 15:2018, section 9.4).
struct ColorTemperature {
    double kelvin;  // from 1000 to 25000
    double duv;     // distance from the locus, above it positive (ANSI C78.377)
};
ColorTemperature correlated_color_temperature(const glm::dvec3& xyz);
constexpr double most_duv = 0.05;  // beyond, colours have no such temperature

}  // namespace etendue
