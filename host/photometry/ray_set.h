// A ray file on the device, and in a line.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/photometry/ray_file.h"
#include "host/spectra/spectral_value.h"

namespace etendue {

// Twin of struct RayFileRef in shaders/lights/rays.glsl, where the layout of the words is described.
struct RayFileRef {
    uint32_t first = 0;   // of the words
    uint32_t count = 0;   // rays
    uint32_t uneven = 0;  // rays differ in flux: there is an alias table
    uint32_t colors = 0;  // of all rays together; 0: they have that of the record, 1: all have the same
    uint32_t first_color = 0;
    float flux = 0;          // lm
    float scale = 1;         // of the record's colour, so that its luminance is 1
    uint32_t polarized = 0;  // rays have Stokes parameters
    glm::vec3 lo{0}, hi{0};  // m, of where rays start
};
static_assert(sizeof(RayFileRef) == 56);

// What a file's rays carry, as the renderer needs it.
struct RaySet {
    RayFileRef ref;  // its colours and `scale` are to be filled in
    // A lumen of the set, as radiance: of the spectra that rays have, mean luminance 1. Empty where the file
    // says nothing of spectra.
    std::vector<SpectralValue> colors;
    std::optional<double> lumens;  // none where the file tells watts and nothing of their spectrum
    double watts = 0;              // 0 where it does not tell
    std::string summary;           // "TM-25, 4000 rays, 1 W, from (0, 0, 0) to (1, 1, 0) mm"
    std::vector<std::string> warnings;
};

// Rays of one wavelength shine in a triangle of this half width, and so of this width at half its height,
// around the nearest whole nanometre: a single one is met by no pass.
constexpr int band_nm = 5;

// Adds the rays to those of other files.
RaySet append_ray_set(std::vector<uint32_t>& words, const RayFile& file);

// lm/W of light of that colour, within 360 to 830 nm.
double luminous_efficacy(const SpectralValue& color);

}  // namespace etendue
