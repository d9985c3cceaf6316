#include "host/measure/glare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace etendue {
namespace {

constexpr size_t least_pixels = 4096;  // fewer are wider than 2.2°, and blur what glares

struct Eye {
    glm::dvec3 sight{0}, up{0};  // unit, at right angles
};
// Of a meter that covers the half space before it with enough pixels.
std::optional<Eye> eye_of(const Meter& meter) {
    if (meter.unit != "cd/m²" || meter.pixels() < least_pixels) return {};
    Eye eye;
    double covered = 0;
    for (const PixelPlace& place : meter.places) {
        eye.sight -= double(place.extent) * glm::dvec3(place.direction);
        covered += place.extent;
    }
    if (std::abs(covered - 2 * glm::pi<double>()) > 0.02) return {};
    eye.sight = glm::normalize(eye.sight);
    const glm::dvec3 up(0, 1, 0);
    eye.up = up - glm::dot(up, eye.sight) * eye.sight;
    if (glm::length(eye.up) < 1e-3) return {};  // it looks straight up or down: no side of it is above
    eye.up = glm::normalize(eye.up);
    return eye;
}

}  // namespace

double position_index(const glm::dvec3& direction, const glm::dvec3& sight, const glm::dvec3& up) {
    const double ahead = std::max(glm::dot(direction, sight), 1e-6), high = glm::dot(direction, up);
    const double aside = std::sqrt(std::max(0.0, 1 - ahead * ahead - high * high));
    double index;
    if (high >= 0) {
        const double sigma = glm::degrees(std::acos(std::min(ahead, 1.0)));
        const double tau = glm::degrees(std::atan2(aside, high));
        index = std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                         (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
    } else {
        const double away = std::hypot(high, aside) / ahead;
        index = 1 + (away < 0.6 ? 0.8 : 1.2) * away;
    }
    return std::clamp(index, 1.0, 16.0);
}

std::vector<Figure> glare_figures(const Meter& meter, const std::vector<std::vector<double>>& values,
                                  double glare_from) {
    const std::optional<Eye> eye = eye_of(meter);
    if (!eye) return {};
    const size_t n = values.size();
    std::vector<Series> glaring;   // luminances
    std::vector<double> disturbs;  // ω / p² of each
    Series whole(n, 0.0), background(n, 0.0);
    double solid_angle = 0;
    for (size_t i = 0; i < meter.pixels(); ++i) {
        const glm::dvec3 direction = -glm::dvec3(meter.places[i].direction);
        const double extent = meter.places[i].extent, across = extent * glm::dot(direction, eye->sight);
        Series pixel;
        for (const auto& replicate : values) pixel.push_back(replicate[i]);
        const bool glares = mean_of(pixel) > glare_from;
        for (size_t k = 0; k < n; ++k) {
            whole[k] += across * pixel[k];
            if (!glares) background[k] += across * pixel[k] / glm::pi<double>();
        }
        if (!glares) continue;
        const double index = position_index(direction, eye->sight, eye->up);
        glaring.push_back(std::move(pixel)), disturbs.push_back(extent / (index * index));
        solid_angle += extent;
    }
    std::vector<Figure> figures = {{"illuminance at the eye", "lx", mean_interval(whole), ""},
                                   {"luminance of the background", "cd/m²", mean_interval(background), ""}};
    const std::string name = fmt::format("UGR, sources above {:.4g} cd/m²", glare_from);
    if (glaring.empty() || !(mean_of(background) > 0)) {
        figures.push_back({name, "", {NAN, NAN, NAN}, glaring.empty() ? "nothing glares" : "no background"});
        return figures;
    }
    glaring.push_back(background);
    const auto rating = [&](const std::vector<double>& means) {
        double sum = 0;
        for (size_t i = 0; i < disturbs.size(); ++i) sum += means[i] * means[i] * disturbs[i];
        return 8 * std::log10(0.25 * sum / means.back());
    };
    figures.push_back(
        {name, "", function_interval(glaring, rating), fmt::format("of {:.3g} sr that glare", solid_angle)});
    return figures;
}

}  // namespace etendue
