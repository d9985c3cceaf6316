// The film: what the passes of one receiver add up to, pixel by pixel.
#pragma once
#include <cstddef>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/kernel.h"
#include "host/image/image.h"
#include "host/render/film_error.h"

namespace etendue {

class Film {
  public:
    // What pixels hold is undefined until clear() or write(). `merging`: its kernels are compiled with
    // MERGE_VERTICES, and pixels hold what tells the bias. `stokes`: with STOKES_IMAGE, and there are S1 to
    // S3, too.
    Film(Device& device, uint32_t width, uint32_t height, bool merging = false, bool stokes = false);
    Film(const Film&) = delete;

    BufferTable buffers() const;  // "Film"; valid as long as the film

    bool merging() const { return merging_; }
    bool stokes() const { return layers_ > 1; }

    void resize(uint32_t width,
                uint32_t height);  // to no more pixels than at first; what they hold is undefined
    void clear();
    // The bytes are those of struct FilmPixel in shaders/lib/film.glsl, for every pixel and layer of it.
    std::vector<std::byte> read() const;
    void write(const std::vector<std::byte>& pixels);  // of a film of the same size and kind

    // Mean radiance as R, G, B, and, where asked for, its error (estimate_errors, which takes longer than all
    // else) as error.R, error.G, error.B; S1.R and error.S1.R to S3 likewise.
    Image develop(bool errors) const;
    RelativeError relative_error() const;  // without developing, which takes longer

  private:
    FilmSums sums(uint32_t layer) const;
    uint64_t bytes() const;
    uint32_t width_, height_, layers_;
    bool merging_;
    Buffer pixels_;
};

// Root of the relMSE that the error layer of an image amounts to: sqrt(mean(error² / (I² + 0.01 mean(I)²)))
// over pixels and channels. Infinite where there is no such layer or it is.
double estimated_relative_error(const Image& image);

}  // namespace etendue
