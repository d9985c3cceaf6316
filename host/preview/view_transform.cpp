#include "host/preview/view_transform.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/spectra/color.h"

namespace etendue {
namespace {

// Powers of two by which highlights darken a picture at most. What lies higher above white would burn out all
// the same: who looks at a lamp wants to see the room.
constexpr double most_held_back = 2;

// Rows as in the literature; glm wants columns.
glm::dmat3 rows(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::transpose(glm::dmat3(a, b, c));
}

glm::dvec3 xyz_of(const glm::dvec2& chromaticity) {
    return {chromaticity.x / chromaticity.y, 1, (1 - chromaticity.x - chromaticity.y) / chromaticity.y};
}

}  // namespace

const char* tone_curve_name(ToneCurve curve) {
    switch (curve) {
        case ToneCurve::linear:
            return "none";
        case ToneCurve::srgb:
            return "sRGB";
        case ToneCurve::aces:
            return "ACES";
        case ToneCurve::agx:
            return "AgX";
        case ToneCurve::false_colors:
            return "false colours";
    }
    return "";
}

ViewTransform view_transform(const ViewSettings& s) {
    const double lowest = std::max(s.lowest, 1e-12), highest = std::max(s.highest, 1.001 * lowest);
    return {glm::mat3(s.temperature ? white_balance(*s.temperature) : glm::dmat3(1.0)),
            float(std::exp2(s.exposure)), uint32_t(s.curve), float(lowest), float(highest)};
}

glm::dvec2 blackbody_chromaticity(double kelvin) {
    const double t = std::clamp(kelvin, 1667.0, 25000.0), u = 1e3 / t;
    const double x = t < 4000 ? -0.2661239 * u * u * u - 0.2343589 * u * u + 0.8776956 * u + 0.179910
                              : -3.0258469 * u * u * u + 2.1070379 * u * u + 0.2226347 * u + 0.240390;
    double y;
    if (t < 2222)
        y = -1.1063814 * x * x * x - 1.34811020 * x * x + 2.18555832 * x - 0.20219683;
    else if (t < 4000)
        y = -0.9549476 * x * x * x - 1.37418593 * x * x + 2.09137015 * x - 0.16748867;
    else
        y = 3.0817580 * x * x * x - 5.87338670 * x * x + 3.75112997 * x - 0.37001483;
    return {x, y};
}

glm::dmat3 white_balance(double kelvin) {
    // IEC 61966-2-1, and the Bradford matrix.
    const glm::dmat3 xyz_from_rgb =
        rows({0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505});
    const glm::dmat3 cones_from_xyz =
        rows({0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296});
    const glm::dmat3 cones_from_rgb = cones_from_xyz * xyz_from_rgb;
    const glm::dvec3 from = cones_from_xyz * xyz_of(blackbody_chromaticity(kelvin)),
                     to = cones_from_rgb * glm::dvec3(1);
    const glm::dvec3 gain = to / from;
    const glm::dmat3 scale(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z);
    return glm::inverse(cones_from_rgb) * scale * cones_from_rgb;
}

double metered_exposure(std::span<const glm::vec3> picture) {
    std::vector<double> stops;  // log2 of the luminance of pixels that light has met
    double sum = 0;
    for (const glm::vec3& rgb : picture) {
        const double y = luminance(glm::dvec3(rgb));
        if (!(y > 1e-12) || !std::isfinite(y)) continue;
        stops.push_back(std::log2(y));
        sum += stops.back();
    }
    if (stops.empty()) return 0;
    const double average = std::log2(0.18) - sum / double(stops.size());
    std::erase_if(stops, [&](double s) { return s + average > most_held_back; });
    const auto bright = stops.begin() + std::ptrdiff_t(size_t(0.99 * double(stops.size() - 1)));
    std::nth_element(stops.begin(), bright, stops.end());
    const double exposure = std::min(average, -*bright);
    return std::round(3 * exposure) / 3;
}

}  // namespace etendue
