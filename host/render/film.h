// The film: what the passes of one receiver add up to, pixel by pixel, and the image with its estimated error.
#pragma once
#include <cstddef>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/kernel.h"
#include "host/image/image.h"

namespace etendue {

class Film {
  public:
    // Empty. Kernels reach a film of more than `binding_bytes` through its address.
    Film(Device& device, uint32_t width, uint32_t height, uint64_t binding_bytes);
    Film(const Film&) = delete;

    bool by_address() const { return by_address_; }
    BufferTable buffers() const;  // "Film", "FilmAddress"; valid as long as the film

    void clear();
    // The bytes are those of struct FilmPixel in shaders/lib/film.glsl, for every pixel.
    std::vector<std::byte> read() const;
    void write(const std::vector<std::byte>& pixels);  // of a film of the same size

    // Mean radiance as R, G, B, and its standard error as error.R, error.G, error.B.
    Image develop() const;

  private:
    uint32_t width_, height_;
    Buffer pixels_, address_;
    bool by_address_;
};

// Root of the estimated relMSE: sqrt(mean(error² / (I² + 0.01 mean(I)²))) over pixels and channels of an
// image with an error layer. Infinite before the second pass.
double estimated_relative_error(const Image& image);

}  // namespace etendue
