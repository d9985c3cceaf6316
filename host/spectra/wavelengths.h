// The wavelengths of a pass. All paths of a pass carry the same four (hero wavelength sampling, Wilkie et al.
// 2014, "Hero Wavelength Spectral Sampling"), so forward and backward paths always meet, and spectra cost
// nothing on the way: their values are looked up once a pass.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "host/spectra/spectrum.h"

namespace etendue {

// nm, of R, G and B where a class needs a wavelength; twin of lane_wavelengths() in
// shaders/features/spectrum.glsl.
constexpr int dominant_nm[3] = {611, 549, 464};

// Twin of struct Wavelengths in shaders/features/spectrum.glsl.
struct Wavelengths {
    glm::vec4 nm;      // of which each path has one for its hero, counted from the first: that is left behind
                       // dispersion
    glm::vec3 rgb[4];  // what one in each contributes to the pixel: density, mean and even_luminance included
    glm::vec4 share;   // … to its radiance, W / (m² sr)
};

// Of pass `pass` of a run. Each of the four has the density wavelength_pdf, and they lie a quarter apart in
// its distribution. Even and odd passes are stratified each in itself and independent of the other, as the
// paths are (shaders/lib/sampler.glsl).
Wavelengths choose_wavelengths(uint64_t pass, uint32_t seed);

// 1/nm, constant within a nanometre; nowhere zero in the visible range. `nm` in [360, 830).
double wavelength_pdf(double nm);

}  // namespace etendue
