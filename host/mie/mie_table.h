// The class `mie` (shaders/phases/mie.glsl): how many spheres scatter, tabulated over angle and wavelength.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/mie/mie_sphere.h"
#include "host/spectra/spectrum.h"

namespace etendue {

// Wavelengths of the table, linear in between; twins in shaders/phases/mie.glsl.
constexpr int mie_first_nm = 360, mie_step_nm = 10, mie_wavelengths = 48;

// Size parameter (mie_sphere.h) of the largest sphere: terms and angles grow with it.
constexpr double most_mie_size = 2000;

struct MieParameters {
    double radius = 0;                           // m, effective
    double variance = 0;                         // effective; 0 = all spheres are the same, else below 0.5
    SpectralTable ior, absorption, surrounding;  // index n - ik of the spheres, that of the medium
    bool operator==(const MieParameters&) const = default;
};

// Twin of struct MieRef in shaders/phases/mie.glsl.
struct MieRef {
    uint32_t first = 0;  // node
    uint32_t cells = 0;  // in either half
};

// For each wavelength 2 cells + 1 nodes, from light that goes straight on to light that comes back. Nodes are
// dense at both ends, where narrow lobes are: 1 - |cosine| is the cube of (number from the nearer end) /
// cells.
struct MieTable {
    MieParameters parameters;
    uint32_t cells = 0;
    std::vector<glm::vec4> values;  // s11 and b, c, d times it (MieElements); 1/sr: linear in the cosine
                                    // between nodes, s11 integrates over the sphere to 1
    std::vector<float> sums;        // integral of s11 from cosine 1 to the node, 0 to 1
};

// The largest size parameter there is, at any wavelength.
double largest_mie_size(const MieParameters& p);

// Sizes have the gamma distribution of Hansen & Travis 1974, "Light scattering in planetary atmospheres",
// equation 2.56. Spheres that are all the same (a variance below 1e-4) are averaged over the wavelengths
// around each of the table's, with its weights, so that the interpolated table has the mean of what
// oscillates faster. `threads`: at least 1; the result is the same for any number. largest_mie_size() must be
// within most_mie_size.
MieTable make_mie_table(const MieParameters& p, unsigned threads);

// The mean over such spheres, computed for that wavelength and cosine, from twice as many sizes at least,
// 1/sr.
MieElements direct_mie_elements(const MieParameters& p, double nm, double cosine);

}  // namespace etendue
