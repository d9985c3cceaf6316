// The film: what passes add up to, pixel by pixel. That of a renderer, which serves several receivers, is a
// single row.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/kernel.h"
#include "host/image/image.h"
#include "host/render/exact_sum.h"
#include "host/render/film_error.h"
#include "host/scene/scene.h"
#include "host/image/pass_set.h"

namespace etendue {

// Which sums a film has.
struct FilmShape {
    uint32_t width = 0, height = 0;
    bool merging = false;  // its kernels are compiled with MERGE_VERTICES, and it holds what tells the bias
    bool stokes = false;   // with STOKES_IMAGE, and there are S1 to S3, too
    std::vector<std::string> light_layers = {};  // behind all light, which is their sum; not with `stokes`
    uint32_t stokes_layers() const { return stokes ? 4 : 1; }
    uint32_t layers() const { return stokes_layers() + uint32_t(light_layers.size()); }
    std::string defines() const;  // of kernels that read or write it
    // Of a layer of a pixel: twin of struct FilmHalf in shaders/lib/film.glsl, of the even and the odd
    // passes.
    uint32_t sums_a_layer() const { return merging ? 6 : 4; }
    uint64_t pixels() const { return uint64_t(width) * height; }
    uint64_t sums_a_pixel() const { return layers() * sums_a_layer(); }
    uint64_t sums() const { return pixels() * sums_a_pixel(); }
};

// Passes write their samples beside the film; once there are a few, or somebody looks, they are added to it.
class Film {
  public:
    // What it holds is undefined until clear() or write(). The time of its kernel is added to `timings`.
    Film(Device& device, Scene& scene, const FilmShape& shape, KernelTimings& timings);
    Film(const Film&) = delete;

    BufferTable buffers() const;  // "Film" and "Samples"; valid as long as the film
    // Passes that there is room for beside the film: pass p stands at p % sample_passes().
    uint32_t sample_passes() const { return sample_passes_; }
    // Before kernels write the samples of passes `first` and later ones: of `wanted`, for how many there is
    // room. These count as passes of the film from here on.
    uint32_t begin_passes(uint64_t first, uint32_t wanted);
    void add_samples();  // those that are not in the film yet
    void warm_up();      // dispatches its kernel on nothing

    const FilmShape& shape() const { return shape_; }

    void resize(uint32_t pixels);  // to no more than at first; what they hold is undefined
    void clear();
    std::vector<ExactSum> read();
    void write(const std::vector<ExactSum>& sums);  // of a film of the same shape

  private:
    bool ends_loops_early_;  // the driver: then not every path leaves a sample
    FilmShape shape_;
    KernelTimings& timings_;
    CommandList commands_;
    Buffer sums_, samples_;
    Kernel accumulate_film_;
    uint32_t sample_passes_ = 0;
    PassRange not_added_;
};

// Mean radiance as R, G, B, and, where asked for, its error (estimate_errors, which takes longer than all
// else) as error.R, error.G, error.B; S1.R and error.S1.R to S3 likewise, or NAME.R and error.NAME.R of
// layers of light.
Image develop_film(const FilmShape& shape, std::span<const ExactSum> sums, const PassSet& passes,
                   bool errors);
// Of R, G and B, without developing, which takes longer.
RelativeError film_relative_error(const FilmShape& shape, std::span<const ExactSum> sums,
                                  const PassSet& passes);

// Root of the relMSE that the error layer of an image amounts to: sqrt(mean(error² / (I² + 0.01 mean(I)²)))
// over pixels and channels. Infinite where there is no such layer or it is.
double estimated_relative_error(const Image& image);

}  // namespace etendue
