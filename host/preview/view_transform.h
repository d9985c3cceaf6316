// How the window shows radiance: exposure, white balance, a tone curve or false colours. The formulas stand
// in shaders/view/tone_curves.glsl; here is what they are given.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

namespace etendue {

enum class ToneCurve : uint32_t { linear, srgb, aces, agx, false_colors };
const char* tone_curve_name(ToneCurve curve);

struct ViewSettings {
    double exposure = 0;                // powers of two
    std::optional<double> temperature;  // K, of the light that shall look white; none = as it is
    ToneCurve curve = ToneCurve::srgb;
    double lowest = 0.01, highest = 100;  // cd/m², ends of the false colours
};

// Twin of struct ViewTransform in shaders/view/tone_curves.glsl.
struct ViewTransform {
    glm::mat3 white_balance;
    float exposure;
    uint32_t curve;
    float lowest, highest;
    bool operator==(const ViewTransform&) const = default;
};
ViewTransform view_transform(const ViewSettings& settings);

constexpr double coolest_white = 15000, warmest_white = 1667;  // K

// Chromaticity x, y of a blackbody, 1667 to 25000 K (Kim et al. 2002, US patent 7024034: cubic splines).
glm::dvec2 blackbody_chromaticity(double kelvin);

// Linear Rec.709 to itself: makes light of that colour temperature white, D65 (von Kries in the Bradford cone
// space: Lam 1985).
glm::dmat3 white_balance(double kelvin);

// Exposure (powers of two) that brings the mean of the logarithms of the luminances to 0.18 (Reinhard et al.
// 2002, eq. 1 and 2), rounded to a third of a stop; 0 where all is black. Where more than 1 % of the pixels
// that are not black would be above white it is less, by 2 at most.
double metered_exposure(std::span<const glm::vec3> picture);

}  // namespace etendue
