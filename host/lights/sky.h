// The CIE general sky, with a sun: what shaders/lights/sky.glsl reads (ISO 15469:2004 / CIE S 011:2003,
// "Spatial distribution of daylight - CIE standard general sky").
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "host/lights/environment_map.h"

namespace etendue {

// a and b of the gradation, c, d and e of the indicatrix (ISO 15469:2004, table 1). Types 1 to 15.
struct SkyCoefficients {
    double a, b, c, d, e;
    bool knows_sun() const { return c != 0 || e != 0; }  // else all azimuths are alike
};
const SkyCoefficients& sky_coefficients(uint32_t type);

// Luminance in a direction above the horizon, over that of the zenith (equation 1). Unit vectors, +y up.
double relative_luminance(const SkyCoefficients& sky, const glm::dvec3& direction, const glm::dvec3& sun);

struct SkyParameters {
    uint32_t type = 12;
    glm::dvec3 sun{0, 1, 0};  // towards it, unit
    double diffuse = 0,
           direct = 0;  // lx, of a horizontal plane by the sky, and by the sun of one that faces it
    double ground = 0;  // reflectance
    double sky_color = 1, sun_color = 1;  // luminance of the colours that they are multiplied by
};

// Mirrors struct SkyRef of lights/sky.glsl.
struct SkyRef {
    EnvironmentMapRef map;
    glm::vec3 sun{0, 1, 0};
    float a = 0, b = -1, c = 0, d = -1, e = 0;
    float sky = 0, disk = 0;
    float ground_of_sky = 0, ground_of_sun = 0;
    float chord = 0;
    float sun_share = 0;
    float integral = 0;
};
static_assert(sizeof(SkyRef) == 80);

struct Sky {
    SkyRef ref;          // `map.first` is 0: add the place of the texels
    EnvironmentMap map;  // as `ref.map`
};
Sky build_sky(const SkyParameters& parameters);

}  // namespace etendue
