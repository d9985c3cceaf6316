#include "host/image/polarization.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "host/spectra/color.h"

namespace etendue {
namespace {

constexpr std::array<const char*, 4> layers = {"", "S1.", "S2.", "S3."};

}  // namespace

PolarizationState polarization_state(const glm::dvec4& s) {
    if (!(s[0] > 0)) return {};
    double angle = 0.5 * std::atan2(s[2], s[1]);
    if (angle < 0) angle += std::numbers::pi;
    return {float(std::hypot(s[1], s[2]) / s[0]), float(angle), float(s[3] / s[0])};
}

bool has_stokes(const Image& image) {
    for (const char* layer : layers)
        for (const char channel : {'R', 'G', 'B'})
            if (find_channel(image, std::string(layer) + channel) < 0) return false;
    return true;
}

std::vector<glm::dvec4> stokes_vectors(const Image& image) {
    std::vector<glm::dvec4> stokes(pixel_count(image));
    for (size_t k = 0; k < 4; ++k) {
        std::array<std::span<const float>, 3> rgb;
        for (size_t c = 0; c < 3; ++c)
            rgb[c] = plane(image, size_t(find_channel(image, std::string(layers[k]) + "RGB"[c])));
        for (size_t i = 0; i < stokes.size(); ++i)
            stokes[i][int(k)] = luminance(glm::dvec3(rgb[0][i], rgb[1][i], rgb[2][i]));
    }
    return stokes;
}

void add_polarization(Image& image) {
    std::vector<PolarizationState> states;
    for (const glm::dvec4& stokes : stokes_vectors(image)) states.push_back(polarization_state(stokes));
    add_channels(image, {"polarization.DoLP", "polarization.AoLP", "polarization.DoCP"},
                 std::span(&states[0].linear, 3 * states.size()), 3);
}

glm::vec3 degree_color(double degree) {
    const float x = float(std::clamp(degree, 0.0, 1.0));
    return {std::min(1.6f * x, 1.0f), x, 0.5f * x * (1 - x)};
}

glm::vec3 angle_color(double angle) {
    glm::vec3 color;
    for (int c = 0; c < 3; ++c)
        color[c] = float(0.5 + 0.5 * std::cos(2 * (angle - c * std::numbers::pi / 3)));
    return color;
}

glm::vec3 signed_degree_color(double degree) {
    const double x = std::clamp(degree, -1.0, 1.0);
    return glm::mix(glm::vec3(0.25f), x > 0 ? glm::vec3(1, 0.2f, 0.1f) : glm::vec3(0.1f, 0.4f, 1),
                    float(std::abs(x)));
}

}  // namespace etendue
