// Mueller matrices over directions that were measured: a file of Baek et al. 2020 ("Image-based acquisition
// and modeling of polarimetric reflectance", ACM Trans. Graph. 39(4), 139), as shaders/lib/mueller_table.glsl
// reads it. A tensor file (tensor_file.h) with the fields
//
//     phi_d, theta_d, theta_h   float32, 1 x N each, rising, rad: the nodes of the difference angles and of
//     the half
//                               vector's angle to the normal (Rusinkiewicz 1998). phi_d goes once around, its
//                               last node, which is the first again, left out or not
//     wvls                      uint16, rising, nm
//     M                         float32, [phi_d][theta_d][theta_h][wvls][4][4]: f, 1/sr, rows first
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "host/spectra/spectral_value.h"

namespace etendue {

// Twin of struct MuellerTable in shaders/lib/mueller_table.glsl. Places are those in the lists of
// MuellerTables.
struct MuellerTable {
    glm::uvec3 axes{0}, nodes{0};  // of phi_d, theta_d, theta_h: their numbers, and how many there are
    uint32_t matrices = 0;         // [phi_d][theta_d][theta_h][wavelength]
    uint32_t wavelengths = 0;
    uint32_t lobe = 0,
             lobe_nodes = 0;  // how half vectors are drawn: sin² theta_h, its density, integral of that
    float cosine_part = 1;    // of the samples, which follow the cosine
    glm::vec3 place_rgb{0};   // SpectrumRef: place of each wavelength among those of the table
    uint32_t place_table = 0;
};
static_assert(sizeof(MuellerTable) == 15 * 4);

// What files hold, one behind the other.
struct MuellerTables {
    std::vector<float> numbers;
    std::vector<float> intensities;  // the first element of each matrix, f of unpolarized light, 1/sr
    // The other fifteen over it, in two vectors a matrix: 16 bits each, snorm, of which the first is 1.
    std::vector<glm::uvec4> ratios;
};

struct MuellerFile {
    MuellerTable table;
    SpectralValue place;  // of wavelengths in `table`; rgb: of those that the channels stand for
};

// Reads a file in slices and adds it to the lists. Where numbers of a matrix are not finite it was not
// measured: the one of the nearest theta_h that was, else of the nearest theta_d, takes its place, else it is
// black. Negative intensities become zero, and matrices physical (without_excess). Then 1e-4 of what is kept
// of the polarization is given up, which makes up for rounding: physical matrices stay so. So intensities are
// exact, and the ratios off by 1.2e-4. What is wrong in the file fails with one line.
MuellerFile read_mueller_file(const std::filesystem::path& path, unsigned threads, MuellerTables& all);

}  // namespace etendue
