#include "host/lights/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {
namespace {

constexpr double pi = std::numbers::pi;
const glm::dvec3 up(0, 1, 0);
constexpr double sun_radius = 0.265 * pi / 180;
// Texels of the map that directions are drawn by. Radiance itself is exact.
constexpr uint32_t map_width = 256, map_height = 128;

glm::dvec3 direction_at(double y, double azimuth) {  // from -z towards +x
    const double across = std::sqrt(std::max(0.0, 1 - y * y));
    return {across * std::sin(azimuth), y, -across * std::cos(azimuth)};
}

// Gradation by the angle from the zenith times indicatrix by that from the sun (equations 2 to 5).
double unscaled_luminance(const SkyCoefficients& sky, const glm::dvec3& direction, const glm::dvec3& sun) {
    const double gradation = direction.y > 0 ? 1 + sky.a * std::exp(sky.b / direction.y) : 1;
    // Not by the arc cosine, which knows small angles badly.
    const double angle = 2 * std::asin(std::min(1.0, 0.5 * glm::length(direction - sun)));
    const double cosine = std::cos(angle);
    return gradation *
           (1 + sky.c * (std::exp(sky.d * angle) - std::exp(sky.d * pi / 2)) + sky.e * cosine * cosine);
}

// Over the sky: of relative luminance, and of that times the cosine to the zenith. Midpoints of rows that
// are closer to each other at the horizon, where luminance may change fast.
struct SkyIntegrals {
    double all = 0, horizontal = 0;
};
SkyIntegrals integrate(const SkyCoefficients& sky, const glm::dvec3& sun) {
    const int rows = 512, columns = sky.knows_sun() ? 512 : 1;
    SkyIntegrals sums;
    for (int i = 0; i < rows; ++i) {
        const double t = (i + 0.5) / rows, y = t * t;
        double ring = 0;
        for (int j = 0; j < columns; ++j)
            ring += relative_luminance(sky, direction_at(y, 2 * pi * (j + 0.5) / columns), sun);
        const double part = ring * 2 * pi / columns * 2 * t / rows;
        sums.all += part, sums.horizontal += part * y;
    }
    return sums;
}

}  // namespace

const SkyCoefficients& sky_coefficients(uint32_t type) {
    static constexpr SkyCoefficients types[] = {
        {4, -0.70, 0, -1.0, 0},      {4, -0.70, 2, -1.5, 0.15},   {1.1, -0.8, 0, -1.0, 0},
        {1.1, -0.8, 2, -1.5, 0.15},  {0, -1.0, 0, -1.0, 0},       {0, -1.0, 2, -1.5, 0.15},
        {0, -1.0, 5, -2.5, 0.30},    {0, -1.0, 10, -3.0, 0.45},   {-1, -0.55, 2, -1.5, 0.15},
        {-1, -0.55, 5, -2.5, 0.30},  {-1, -0.55, 10, -3.0, 0.45}, {-1, -0.32, 10, -3.0, 0.45},
        {-1, -0.32, 16, -3.0, 0.30}, {-1, -0.15, 16, -3.0, 0.30}, {-1, -0.15, 24, -2.8, 0.15}};
    return types[type - 1];
}

double relative_luminance(const SkyCoefficients& sky, const glm::dvec3& direction, const glm::dvec3& sun) {
    return unscaled_luminance(sky, direction, sun) / unscaled_luminance(sky, up, sun);
}

Sky build_sky(const SkyParameters& p) {
    const SkyCoefficients& c = sky_coefficients(p.type);
    const SkyIntegrals of_sky = integrate(c, p.sun);
    const double zenith = p.diffuse / of_sky.horizontal;  // cd/m²
    const double sun_horizontal = p.direct * std::max(0.0, p.sun.y);
    const double ground_of_sky = p.ground * p.diffuse / pi, ground_of_sun = p.ground * sun_horizontal / pi;
    const double ground = ground_of_sky + ground_of_sun;

    ImageDescription image;
    image.name = "sky";
    image.width = map_width, image.height = map_height;
    image.rgba32f.reserve(size_t(4) * map_width * map_height);
    for (uint32_t row = 0; row < map_height; ++row)
        for (uint32_t column = 0; column < map_width; ++column) {
            const double y = std::cos(pi * (row + 0.5) / map_height);
            const double azimuth = 2 * pi * ((column + 0.5) / map_width - 0.5);
            const double luminance =
                y > 0 ? zenith * relative_luminance(c, direction_at(y, azimuth), p.sun) : ground;
            const float l = float(luminance);
            image.rgba32f.insert(image.rgba32f.end(), {l, l, l, 1});
        }
    Sky sky;
    sky.map = build_environment_map(image);

    SkyRef& r = sky.ref;
    r.map = sky.map.ref;
    r.sun = glm::vec3(p.sun);
    r.a = float(c.a), r.b = float(c.b), r.c = float(c.c), r.d = float(c.d), r.e = float(c.e);
    r.sky = float(zenith / unscaled_luminance(c, up, p.sun) / p.sky_color);
    r.disk = float(p.direct / (pi * std::sin(sun_radius) * std::sin(sun_radius)) / p.sun_color);
    r.ground_of_sky = float(ground_of_sky / p.sky_color),
    r.ground_of_sun = float(ground_of_sun / p.sun_color);
    r.chord = float(2 * std::sin(0.5 * sun_radius));
    const double without_sun = zenith * of_sky.all + 2 * pi * ground;
    r.integral = float(without_sun + p.direct);
    r.sun_share = r.integral > 0 ? float(p.direct / (without_sun + p.direct)) : 0;
    return sky;
}

}  // namespace etendue
