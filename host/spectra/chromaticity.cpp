#include "host/spectra/chromaticity.h"

#include <cmath>

#include "host/spectra/color.h"
#include "host/spectra/spectrum.h"

namespace etendue {
namespace {

glm::dvec2 locus(double mired) {
    return uv_1960(xyz_of_radiance(tabulate([&](double nm) { return blackbody_radiance(1e6 / mired, nm); })));
}

}  // namespace

glm::dvec2 chromaticity_xy(const glm::dvec3& xyz) { return glm::dvec2(xyz) / (xyz.x + xyz.y + xyz.z); }

glm::dvec2 chromaticity_uv(const glm::dvec3& xyz) {
    return glm::dvec2(4 * xyz.x, 9 * xyz.y) / (xyz.x + 15 * xyz.y + 3 * xyz.z);
}

glm::dvec2 uv_1960(const glm::dvec3& xyz) {
    const glm::dvec2 uv = chromaticity_uv(xyz);
    return {uv.x, uv.y * 2 / 3};
}

// Golden-section search in reciprocal temperatures, along which the locus is nearly even.
ColorTemperature correlated_color_temperature(const glm::dvec3& xyz) {
    const glm::dvec2 uv = uv_1960(xyz);
    const auto off = [&](double mired) { return glm::length(uv - locus(mired)); };
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    double lo = 40, hi = 1000;
    double a = hi - golden * (hi - lo), b = lo + golden * (hi - lo), off_a = off(a), off_b = off(b);
    while (hi - lo > 1e-4) {
        if (off_a < off_b) {
            hi = b, b = a, off_b = off_a;
            a = hi - golden * (hi - lo), off_a = off(a);
        } else {
            lo = a, a = b, off_a = off_b;
            b = lo + golden * (hi - lo), off_b = off(b);
        }
    }
    const double mired = 0.5 * (lo + hi);
    const glm::dvec2 nearest = locus(mired), along = locus(mired + 1) - nearest;  // to the right, to the red
    const double above = along.x * (uv - nearest).y - along.y * (uv - nearest).x;
    return {1e6 / mired, std::copysign(glm::length(uv - nearest), above)};
}

}  // namespace etendue
