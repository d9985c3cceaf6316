#include "host/spectra/color_rendering.h"

#include <fmt/format.h>

#include <cmath>

#include "host/spectra/chromaticity.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"

namespace etendue {
namespace {

const std::array<SpectralTable, 14>& test_colors() {
    static const auto tables = [] {
        std::array<SpectralTable, 14> result;
        for (size_t i = 0; i < result.size(); ++i)
            result[i] = library_table(fmt::format("CIE test colour {}", i + 1), Outside::hold);
        return result;
    }();
    return tables;
}

SpectralTable reference_of(double kelvin) {
    return kelvin < 5000 ? tabulate([&](double nm) { return blackbody_radiance(kelvin, nm); })
                         : cie_daylight(kelvin);
}

// A colour under some light: its place in CIE 1960, and Y of the light's white being 100.
struct Seen {
    glm::dvec2 uv;
    double y;
};
Seen seen(const SpectralTable& light, double white_y) {
    const glm::dvec3 xyz = xyz_of_radiance(light);
    return {uv_1960(xyz), 100 * xyz.y / white_y};
}

// Equations 4 and 5: c and d.
glm::dvec2 cone_ratios(const glm::dvec2& uv) {
    return glm::dvec2(4 - uv.x - 10 * uv.y, 1.708 * uv.y + 0.404 - 1.481 * uv.x) / uv.y;
}

// Equation 3: what an eye adapted to one white sees as one adapted to another, of which `to_other` is the
// ratio of their c and d (von Kries).
glm::dvec2 adapted(const glm::dvec2& uv, const glm::dvec2& to_other) {
    const glm::dvec2 cd = to_other * cone_ratios(uv);
    return glm::dvec2(10.872 + 0.404 * cd.x - 4 * cd.y, 5.520) / (16.518 + 1.481 * cd.x - cd.y);
}

// Equation 6: U*, V*, W* of CIE 1964.
glm::dvec3 uvw(const glm::dvec2& uv, double y, const glm::dvec2& white) {
    const double w = 25 * std::cbrt(y) - 17;
    return {13 * w * (uv - white), w};
}

}  // namespace

SpectralTable cie_daylight(double kelvin) {
    static const SpectralTable s0 = library_table("CIE daylight S0", Outside::zero),
                               s1 = library_table("CIE daylight S1", Outside::zero),
                               s2 = library_table("CIE daylight S2", Outside::zero);
    const double r = 1e3 / kelvin;
    const double x = kelvin <= 7000 ? ((-4.6070 * r + 2.9678) * r + 0.09911) * r + 0.244063
                                    : ((-2.0064 * r + 1.9018) * r + 0.24748) * r + 0.237040;
    const double y = (-3 * x + 2.870) * x - 0.275;
    const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
    const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m, m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    return tabulate([&](double nm) { return s0.at(nm) + m1 * s1.at(nm) + m2 * s2.at(nm); });
}

ColorRendering color_rendering(const SpectralTable& light) {
    const glm::dvec3 xyz = xyz_of_radiance(light);
    ColorRendering result;
    result.kelvin = correlated_color_temperature(xyz).kelvin;
    const SpectralTable reference = reference_of(result.kelvin);
    const double white_y = xyz.y, reference_y = xyz_of_radiance(reference).y;
    const glm::dvec2 white = seen(light, white_y).uv, reference_white = seen(reference, reference_y).uv;
    result.off_reference = glm::length(white - reference_white);
    const glm::dvec2 to_reference = cone_ratios(reference_white) / cone_ratios(white);
    for (size_t i = 0; i < result.each.size(); ++i) {
        const Seen under_light = seen(light * test_colors()[i], white_y);
        const Seen under_reference = seen(reference * test_colors()[i], reference_y);
        const glm::dvec3 difference =
            uvw(adapted(under_light.uv, to_reference), under_light.y, reference_white) -
            uvw(under_reference.uv, under_reference.y, reference_white);
        result.each[i] = 100 - 4.6 * glm::length(difference);
    }
    result.general = 0;
    for (size_t i = 0; i < 8; ++i) result.general += result.each[i] / 8;
    return result;
}

}  // namespace etendue
