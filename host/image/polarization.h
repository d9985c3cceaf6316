// How light is polarized, told from the layers S1 to S3 of an image; of luminances, all wavelengths together.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/image/image.h"

namespace etendue {

struct PolarizationState {
    float linear = 0;    // degree, 0 to 1
    float angle = 0;     // of that, rad in [0, pi), from the rows' direction to the right, counter-clockwise
    float circular = 0;  // degree, -1 to 1, right-handed positive
};

// S0 to S3 in any unit. Nothing is polarized where there is no light.
PolarizationState polarization_state(const glm::dvec4& stokes);

bool has_stokes(const Image& image);
std::vector<glm::dvec4> stokes_vectors(const Image& image);  // of the pixels of an image that has them

// Adds polarization.DoLP, polarization.AoLP and polarization.DoCP to an image that has S1 to S3.
void add_polarization(Image& image);

// False colours, encoded for a screen, for a degree from 0 to 1 (black to yellow), an angle (a wheel of hues,
// the same again after pi) and a degree from -1 to 1 (blue over grey to red).
glm::vec3 degree_color(double degree);
glm::vec3 angle_color(double angle);
glm::vec3 signed_degree_color(double degree);

}  // namespace etendue
