// The film of a spectral image: the spectrum of every pixel in equal bins over the visible range (first_nm to
// last_nm), twin of shaders/features/spectral_film.glsl.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/kernel.h"
#include "host/image/image.h"
#include "host/render/exact_sum.h"

namespace etendue {

// Three bins each.
inline uint64_t spectral_sums(uint64_t pixels, uint32_t bins, uint32_t layers) {
    return pixels * layers * ((bins + 2) / 3);
}

class SpectralFilm {
  public:
    SpectralFilm(Device& device, uint32_t pixels, uint32_t bins, bool stokes = false);  // S1 to S3, too
    BufferTable buffers() const;
    void resize(uint32_t pixels) { pixels_ = pixels; }  // as Film::resize
    void clear();
    std::vector<ExactSum> read() const;
    void write(const std::vector<ExactSum>& sums);  // of a film of the same size

  private:
    uint64_t sums() const { return spectral_sums(pixels_, bins_, layers_); }
    uint32_t pixels_, bins_, layers_;
    Buffer sums_;
};

// Adds a channel a bin to an image (and S1 to S3, with four layers), the mean over `passes` of the spectral
// radiance in the bin, W / (m² sr nm), and the attributes of the layout of Fichet, Pacanowski & Wilkie 2021,
// "An OpenEXR Layout for Spectral Images".
void add_spectra(Image& image, std::span<const ExactSum> sums, uint32_t bins, uint32_t layers,
                 uint64_t passes);

// "S0.550,000000nm": of a bin by the wavelength in its middle; `parameter`: of the Stokes vector.
std::string spectral_channel(uint32_t bin, uint32_t bins, uint32_t parameter = 0);

}  // namespace etendue
