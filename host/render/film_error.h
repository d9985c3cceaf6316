// The error of a film, told from the film alone.
//
// A pixel's samples are stratified over its passes, so the spread of the samples overstates the error of
// their mean. The even and the odd passes are independent of each other, though: the squared difference of
// their means tells the variance of the mean without assuming anything, if with one degree of freedom only.
// So the spread of a pixel's samples says how the error is distributed over the image, and the differences of
// the halves, pooled over neighbouring pixels, say how large it is.
//
// What no sample has met no film can tell: where a light or a highlight smaller than a pixel was missed by
// all passes so far, the error is understated. Over glossy plates (tests/renders/error_test.cpp) the root
// mean square of true by stated error is 1.5 after 16 passes and 1.0 without the largest thousandth of the
// pixels.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace etendue {

// Of one layer of a pixel, over the even passes and over the odd ones.
struct FilmPixel {
    glm::dvec3 sums[2];
    glm::vec3 squares[2];
};
// What merging adds to it (shaders/features/bias.glsl).
struct FilmBias {
    glm::vec3 sums[2];
};

struct FilmSums {
    uint32_t width = 0, height = 0;
    uint64_t even = 0, odd = 0;  // passes
    std::vector<FilmPixel> pixels;
    std::vector<FilmBias> bias;  // empty without merging
    uint64_t passes() const { return even + odd; }
};

glm::dvec3 mean(const FilmSums& film, const FilmPixel& pixel);  // 0 before the first pass

// Root of the expected square of each pixel's difference from the truth, by channel: standard error and, with
// merging, bias. Infinite until there is an even pass and an odd one.
std::vector<glm::vec3> estimate_errors(const FilmSums& film);

// Of the relMSE: mean((I - truth)² / (truth² + 0.01 mean(truth)²)) over pixels and channels.
struct RelativeError {
    double mean_square = 0;  // estimated
    double deviation = 0;    // standard deviation of (true relMSE - mean_square)
    double value() const;    // root of the estimate
    double bound() const;    // what the root of the true relMSE does not exceed, with 95 % confidence
};
RelativeError estimate_relative_error(const FilmSums& film);  // infinite likewise

// When to stop for an error: once its bound lies below. Stopping at the first of many looks that happens to
// please would stop too early; so a look is taken only where the film has grown by an eighth since the last.
struct ErrorGoal {
    double goal;
    uint64_t next_look = 16;  // passes
    bool is_due(uint64_t passes) const { return passes >= next_look; }
    bool look(uint64_t passes, const RelativeError& error) {
        next_look =
            std::min(passes + passes / 8 + 1, std::bit_ceil(passes + 1));  // where Sobol' samples pay off
        return error.bound() <= goal;
    }
};

}  // namespace etendue
