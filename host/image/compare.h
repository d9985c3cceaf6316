// How far an image is from its reference.
//
// `image` is I and `reference` R below. Pixels that are not finite in either are left out of every mean and
// counted.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/image/image.h"

namespace etendue {

struct PixelDifference {
    uint32_t x = 0, y = 0;                // from the left, from the top
    double relative_squared = 0;          // this pixel's term of relMSE, averaged over channels
    std::vector<float> image, reference;  // values in the order of Comparison::channels
};

// Do the two images differ by more than their noise? z = (I - R) / sqrt(error_I² + error_R²) for every value.
// The largest |z| of n independent values of equal mean stays below the limit with probability 1 - alpha
// (Šidák 1967). Errors estimated from few passes make tails heavier than Gaussian: where the images say how
// many passes they have, p-values are Student's, with degrees of freedom after Welch (1947).
struct ZTest {
    size_t tests = 0;
    double max_z = 0;       // largest |z|
    uint32_t x = 0, y = 0;  // where it is (the tile's first pixel)
    double beyond_3 = 0;    // fraction of |z| > 3; 0.0027 is expected of Gaussian noise
    double rms_z = 0;    // 1 is expected; less where the errors are overestimated, as by stratified samples
    double p_value = 1;  // of the least probable value
    double p_limit = 0;  // passes where p_value >= p_limit
    bool passes = true;
};

inline constexpr uint32_t z_tile = 16;

// S1 to S3 of two images that have them: differences in units of the mean intensity of the reference, and the
// tests over all three.
struct StokesComparison {
    std::array<double, 3> rms{}, bias{};
    std::optional<ZTest> z_test, tile_test;
};

// The bins of two spectral images, pixel by pixel.
struct SpectraComparison {
    size_t bins = 0;              // 0: they are not the same, and nothing is compared
    double relmse = 0, bias = 0;  // as of colours
    double worst_bias = 0;        // of the bins' means, the one furthest from zero,
    std::string worst_bin;        //   and its channel
};

struct Comparison {
    uint32_t width = 0, height = 0;
    std::vector<std::string> channels;   // those compared
    double relmse = 0;                   // mean((I-R)² / (R² + 0.01 mean(R)²)), over pixels and channels
    double rmse = 0;                     // sqrt(mean((I-R)²))
    double bias = 0;                     // (mean(I) - mean(R)) / mean(R), over all channels
    std::vector<double> channel_bias;    // the same for each channel
    std::vector<PixelDifference> worst;  // worst first
    size_t nonfinite_image = 0, nonfinite_reference = 0;  // pixels
    std::optional<ZTest> z_test;                          // where both images have an error layer
    std::optional<ZTest> tile_test;                       // the same over tiles of z_tile * z_tile pixels
    std::optional<StokesComparison> stokes;
    std::optional<SpectraComparison> spectra;  // where one of them has any
};

// Compares R, G, B where both have them, else all channels but A and the layers of --aovs. Fails with one
// line where sizes or channels differ. The names stand in messages.
Comparison compare_images(const Image& image, const Image& reference, const std::string& image_name = "image",
                          const std::string& reference_name = "reference", size_t worst_pixels = 5);

// The test over means of tiles of tile * tile pixels, which sees small differences that many pixels share.
// nullopt where an image lacks the error layer of a channel.
std::optional<ZTest> z_test(const Image& image, const Image& reference,
                            const std::vector<std::string>& channels, uint32_t tile = 1, double alpha = 0.01);

// P(|T| > t) for Student's t with `dof` degrees of freedom; an infinite dof gives the normal distribution.
double student_two_sided(double t, double dof);

}  // namespace etendue
