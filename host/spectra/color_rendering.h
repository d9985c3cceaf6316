// How light renders colours: the indices of CIE 13.3-1995, "Method of measuring and specifying colour
// rendering properties of light sources".
#pragma once
#include <array>

#include "host/spectra/spectrum.h"

namespace etendue {

// CIE daylight of that temperature, 4000 to 25000 K, of any scale (CIE 15:2018, section 4.1.2).
SpectralTable cie_daylight(double kelvin);

struct ColorRendering {
    double kelvin;                // of the reference: a black body below 5000 K, CIE daylight from there on
    double off_reference;         // distance from its chromaticity in u, v of CIE 1960
    double general;               // Ra, the mean of the first eight
    std::array<double, 14> each;  // R1 to R14; 100 = as under the reference, and there may be less than 0
};
// Of light of a spectral power in any unit, above 0 somewhere. Where it is further from its reference than
// `most_off_reference` the indices say nothing (CIE 13.3, section 5.3).
ColorRendering color_rendering(const SpectralTable& light);
constexpr double most_off_reference = 5.4e-3;

}  // namespace etendue
