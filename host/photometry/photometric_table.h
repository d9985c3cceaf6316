// A photometric file on the device, and in a line.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/photometry/intensity_distribution.h"

namespace etendue {

// Twin of struct PhotometryRef in shaders/lights/ies.glsl, where the layout of the table is described.
struct PhotometryRef {
    uint32_t first = 0;
    uint32_t planes = 0, angles = 0;
    uint32_t type = 0;
    float start = 0, flux = 0, cos_lit = -1;
    uint32_t shape = 0, axis = 2;
    glm::vec3 size{0};
};
static_assert(sizeof(PhotometryRef) == 48);

// Adds the table to those of other files.
PhotometryRef append_photometric_table(std::vector<float>& values, const IntensityDistribution& d);

// "1200 lm, peak 850 cd, opening disk of diameter 0.1 m".
std::string photometric_summary(const IntensityDistribution& d);

}  // namespace etendue
