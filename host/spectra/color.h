// Between spectra and colours: the CIE 1931 observer of 2 degrees, and linear Rec.709 (ITU-R BT.709-6), whose
// white is that observer's D65.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/spectra/spectrum.h"

namespace etendue {

// Photometric: of a spectral radiance in W / (m² sr nm), X, Y, Z in cd/m² (683 lm/W).
glm::dvec3 xyz_of_radiance(const SpectralTable& radiance);
// The same as the renderer's unit of colour, in which white of luminance 1 cd/m² is (1, 1, 1).
glm::dvec3 rgb_of_radiance(const SpectralTable& radiance);
glm::dvec3 xyz_of_rgb(const glm::dvec3& rgb);
glm::dvec3 rgb_of_xyz(const glm::dvec3& xyz);
// CIE luminance Y of linear Rec.709.
double luminance(const glm::dvec3& rgb);
// What a wavelength contributes to that: rgb_of_radiance is the sum over nanometres of radiance times this.
const std::array<glm::dvec3, spectrum_samples>& rgb_weights();
// D65 of luminance 1 cd/m².
const SpectralTable& white_light();
// A reflectance, transmittance or other factor as it looks under D65. Channels weigh some wavelengths
// negatively: what is positive, or at most one, at all wavelengths is kept so.
glm::dvec3 rgb_of_factor(const SpectralTable& factor);

// Smooth spectra for colours: S(λ) = 1/2 + x / (2 sqrt(1 + x²)), x a quadratic in t = (λ - 360 nm) / 470 nm
// with these coefficients, highest power first, fitted so that S looks like the colour under D65 (Jakob &
// Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling"). Channels in [0, 1];
// colours that no S reaches get the nearest in linear Rec.709. `start` is where the fit begins.
glm::dvec3 fit_smooth_spectrum(const glm::dvec3& rgb, const glm::dvec3& start);
SpectralTable smooth_spectrum(const glm::dvec3& coefficients);

// Coefficients of smooth spectra for all colours with channels in [0, 1], for interpolation by factor_of_rgb
// of shaders/features/spectrum.glsl: for each channel that is the greatest a cube, along x and y the ratios of the
// next two channels (cyclically) to it, along z its level g: z = sqrt(g / 2) below 1/2, 1 - sqrt((1 - g) / 2)
// above.
constexpr uint32_t color_lattice = 24;  // points an axis
constexpr size_t color_spectra_count = 3 * size_t(color_lattice) * color_lattice * color_lattice;
const std::vector<glm::vec4>& color_spectra();

// The scale of radiances on the device: the luminance of a radiance of 1 W / (m² sr nm) at all wavelengths,
// cd/m². Divided into its units, an even spectrum of luminance 1 is 1.
double even_luminance();

// A factor of that colour, constant where it is grey. Channels above 1 scale the whole.
SpectralTable factor_of_rgb(const glm::dvec3& rgb);
// Light of that colour, on D65, W / (m² sr nm).
SpectralTable radiance_of_rgb(const glm::dvec3& rgb);

}  // namespace etendue
