#include "host/render/film_error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

using Plane = std::vector<float>;  // one value a pixel

constexpr double rounding = 4 * 0x1p-24;  // of a mean of squares, relative

// What a channel's samples say of the variance of their mean.
struct Variance {
    double spread = 0;  // from the sum of squares, as if samples were independent
    double halves = 0;  // from the difference of the halves: unbiased, one degree of freedom
    double even_mean = 0, odd_mean = 0;
};

Variance variance(const FilmSums& film, const FilmPixel& p, int c) {
    const double even = double(film.even), odd = double(film.odd), n = even + odd;
    const double mean = (p.sums[0][c] + p.sums[1][c]) / n;
    Variance v;
    v.even_mean = p.sums[0][c] / even;
    v.odd_mean = p.sums[1][c] / odd;
    // Means of e and o samples of variance s² differ by s² (1/e + 1/o) in the mean square.
    const double difference = v.even_mean - v.odd_mean;
    v.halves = difference * difference * even * odd / (n * n);
    const double mean_square = (double(p.squares[0][c]) + double(p.squares[1][c])) / n,
                 centred = mean_square - mean * mean;
    // Squares are floats before they are summed: below their rounding only the halves tell anything.
    v.spread = n > 2 && centred > rounding * mean_square ? centred / (n - 1) : v.halves;
    return v;
}

// Half the difference that the two halves make of the spread, all channels together: its square is the
// variance of the spread. The spread itself where nothing better can be told.
double spread_noise(const FilmSums& film, const FilmPixel& p, const std::array<Variance, 3>& v) {
    const double even = double(film.even), odd = double(film.odd), n = even + odd;
    double even_square = 0, odd_square = 0, spread = 0;
    for (int c = 0; c < 3; ++c) {
        even_square += double(p.squares[0][c]) / even;
        odd_square += double(p.squares[1][c]) / odd;
        spread += v[size_t(c)].spread;
    }
    const double unknown = rounding * (even_square + odd_square);
    for (const Variance& channel : v) {
        even_square -= channel.even_mean * channel.even_mean;
        odd_square -= channel.odd_mean * channel.odd_mean;
    }
    if (even < 2 || odd < 2 || even_square + odd_square <= unknown) return spread;
    const double even_variance = std::max(0.0, even_square) / (even - 1) * even / n,
                 odd_variance = std::max(0.0, odd_square) / (odd - 1) * odd / n;
    return 0.5 * (even_variance - odd_variance);
}

// Means over windows of (2 radius + 1)² pixels, clipped at the border, twice: a tent.
class Neighbourhoods {
  public:
    Neighbourhoods(uint32_t width, uint32_t height) : width_(int(width)), height_(int(height)) {}
    Plane tent(const Plane& values, int radius) const { return box(box(values, radius), radius); }

  private:
    Plane box(const Plane& values, int radius) const {
        Plane rows(values.size()), result(values.size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const int first = std::max(0, x - radius), last = std::min(width_ - 1, x + radius);
                float sum = 0;
                for (int i = first; i <= last; ++i) sum += values[at(i, y)];
                rows[at(x, y)] = sum / float(last - first + 1);
            }
        for (int y = 0; y < height_; ++y) {
            const int first = std::max(0, y - radius), last = std::min(height_ - 1, y + radius);
            for (int i = first; i <= last; ++i)
                for (int x = 0; x < width_; ++x) result[at(x, y)] += rows[at(x, i)] / float(last - first + 1);
        }
        return result;
    }
    size_t at(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }
    int width_, height_;
};

Plane combine(const Plane& a, const Plane& b, auto&& f) {
    Plane result(a.size());
    for (size_t i = 0; i < a.size(); ++i) result[i] = f(a[i], b[i]);
    return result;
}
Plane square(const Plane& a) {
    return combine(a, a, [](float x, float y) { return x * y; });
}

constexpr int levels = 3;
constexpr int radii[levels] = {1, 3, 7};
constexpr float pseudo_samples = 16;   // that a pixel's neighbourhood counts for at least
constexpr float largest_square = 100;  // that a difference counts for, in units of its variance

// How much of each level's mean gives way to the next wider one: the part of their difference that is noise
// (empirical Bayes: James & Stein 1961). A pixel that has not yet met its rare bright sample has neighbours
// that have: there the spread of a single pixel is nothing but noise, and the neighbourhood decides.
std::array<Plane, levels> shrinkage(const Neighbourhoods& near, const Plane& spread, const Plane& noise,
                                    float passes) {
    std::array<Plane, levels + 1> means = {spread}, noises = {noise};
    for (size_t l = 0; l < levels; ++l) {
        means[l + 1] = near.tent(spread, radii[l]);
        noises[l + 1] = near.tent(noise, radii[l]);
    }
    std::array<Plane, levels> shares;
    Plane estimate = means[levels];
    for (size_t l = levels; l-- > 0;) {
        const int radius = radii[std::min<size_t>(l + 1, levels - 1)];
        const Plane total =
            near.tent(square(combine(means[l], estimate, [](float a, float b) { return a - b; })), radius);
        const float least = l == 0 ? pseudo_samples / (pseudo_samples + passes) : 0.0f;
        // Below four passes the halves have no spread of their own.
        const bool known = passes >= 4;
        shares[l] = combine(near.tent(square(noises[l]), radius), total, [&](float n, float t) {
            if (!known) return l < 2 ? 1.0f : 0.0f;
            return std::max(least, n < t ? n / t : 1.0f);
        });
        for (size_t i = 0; i < estimate.size(); ++i)
            estimate[i] = means[l][i] + shares[l][i] * (estimate[i] - means[l][i]);
    }
    return shares;
}

Plane shrink(const Neighbourhoods& near, const Plane& spread, const std::array<Plane, levels>& shares) {
    Plane estimate = near.tent(spread, radii[levels - 1]);
    for (size_t l = levels; l-- > 0;) {
        const Plane mean = l == 0 ? spread : near.tent(spread, radii[l - 1]);
        for (size_t i = 0; i < estimate.size(); ++i)
            estimate[i] = mean[i] + shares[l][i] * (estimate[i] - mean[i]);
    }
    return estimate;
}

// Mean of the squared differences of the halves in units of the variance that is taken for theirs, over the
// nearest pixels as far as these are not noise, else over a wider neighbourhood. Stratification does little
// for a pixel that a silhouette or a highlight crosses, and much for the smooth ones beside it: a neighbour
// counts as far as its spread is like the pixel's. `valid`: 1 where a pixel has such a value.
Plane pooled_ratio(const Neighbourhoods& near, const FilmSums& film, const Plane& spread, const Plane& ratio,
                   const Plane& valid) {
    const float prior = 2;  // pixels that the whole image counts for, and a ratio of 1 in the whole image
    double total_ratio = prior, total_valid = prior;
    for (size_t i = 0; i < ratio.size(); ++i)
        total_ratio += double(ratio[i]), total_valid += double(valid[i]);
    const float everywhere = float(total_ratio / total_valid);
    const int width = int(film.width), height = int(film.height);
    // Sums over a tent of `radius`, which is 1 at the pixel itself.
    const auto pool = [&](int x, int y, int radius) {
        const size_t i = size_t(y) * film.width + size_t(x);
        float sum = 0, count = 0;
        for (int v = std::max(0, y - radius); v <= std::min(height - 1, y + radius); ++v)
            for (int u = std::max(0, x - radius); u <= std::min(width - 1, x + radius); ++u) {
                const size_t k = size_t(v) * film.width + size_t(u);
                const auto [least, most] = std::minmax(spread[i], spread[k]);
                if (!(least > 0)) continue;
                const float tent = float((radius + 1 - std::abs(u - x)) * (radius + 1 - std::abs(v - y))) /
                                   float((radius + 1) * (radius + 1));
                const float weight = tent * least / most;
                sum += weight * ratio[k], count += weight * valid[k];
            }
        return std::pair(sum, count);
    };
    Plane mean(ratio.size()), wide(ratio.size()), noise(ratio.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const size_t i = size_t(y) * film.width + size_t(x);
            const auto [sum, count] = pool(x, y, 2);
            const auto [wide_sum, wide_count] = pool(x, y, 6);
            wide[i] = (wide_sum + prior * everywhere) / (wide_count + prior);
            mean[i] = count > 0 ? sum / count : wide[i];
            // A square of one degree of freedom has twice the square of its mean for variance.
            noise[i] = 2 * wide[i] * wide[i] / std::max(count, 1e-6f);
        }
    const Plane total = near.tent(square(combine(mean, wide, [](float a, float b) { return a - b; })), 3);
    for (size_t i = 0; i < ratio.size(); ++i)
        mean[i] += (noise[i] < total[i] ? noise[i] / total[i] : 1.0f) * (wide[i] - mean[i]);
    return mean;
}

// Square of the bias of the mean. The halves' estimates of it are independent, so that their product has the
// square for mean, without the noise of either.
Plane squared_bias(const Neighbourhoods& near, const FilmSums& film, int c) {
    Plane even(film.pixels.size()), odd(film.pixels.size());
    for (size_t i = 0; i < even.size(); ++i) {
        const FilmBias& b = film.bias[i];  // of half the bias
        even[i] = float(2 * double(b.sums[0][c]) / double(film.even));
        odd[i] = float(2 * double(b.sums[1][c]) / double(film.odd));
    }
    const Plane product =
        combine(near.tent(even, 1), near.tent(odd, 1), [](float a, float b) { return a * b; });
    Plane result = near.tent(product, 3);
    for (float& b : result) b = std::max(b, 0.0f);
    return result;
}

bool has_both_halves(const FilmSums& film) { return film.even > 0 && film.odd > 0; }

}  // namespace

glm::dvec3 mean(const FilmSums& film, const FilmPixel& pixel) {
    if (film.passes() == 0) return glm::dvec3(0);
    return (pixel.sums[0] + pixel.sums[1]) / double(film.passes());
}

std::vector<glm::vec3> estimate_errors(const FilmSums& film) {
    const size_t count = film.pixels.size();
    if (!has_both_halves(film)) return std::vector<glm::vec3>(count, glm::vec3(INFINITY));
    const Neighbourhoods near(film.width, film.height);
    std::array<Plane, 3> spread, halves;
    for (size_t c = 0; c < 3; ++c) spread[c].resize(count), halves[c].resize(count);
    Plane all(count), noise(count);
    for (size_t i = 0; i < count; ++i) {
        std::array<Variance, 3> v;
        for (size_t c = 0; c < 3; ++c) {
            v[c] = variance(film, film.pixels[i], int(c));
            spread[c][i] = float(v[c].spread), halves[c][i] = float(v[c].halves);
            all[i] += spread[c][i];
        }
        noise[i] = float(spread_noise(film, film.pixels[i], v));
    }
    const auto shares = shrinkage(near, all, noise, float(film.passes()));
    for (Plane& channel : spread) channel = shrink(near, channel, shares);
    Plane ratio(count), valid(count), total(count);
    for (const Plane& channel : spread)
        for (size_t i = 0; i < count; ++i) total[i] += channel[i];
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < 3; ++c)
            if (spread[c][i] > 0) {
                ratio[i] += std::min(halves[c][i] / spread[c][i], largest_square) / 3;
                valid[i] += 1.0f / 3;
            }
    const Plane factor = pooled_ratio(near, film, total, ratio, valid);
    std::vector<glm::vec3> errors(count);
    for (size_t c = 0; c < 3; ++c) {
        const Plane bias = film.bias.empty() ? Plane(count) : squared_bias(near, film, int(c));
        for (size_t i = 0; i < count; ++i) errors[i][int(c)] = std::sqrt(spread[c][i] * factor[i] + bias[i]);
    }
    return errors;
}

double RelativeError::value() const { return std::sqrt(mean_square); }

double RelativeError::bound() const {
    // The few bright pixels that make most of the estimate make its deviation, too: both are too small
    // together. So it is the logarithm that is taken as normally distributed.
    const double quantile = 1.645;  // 95 %
    return mean_square > 0 ? std::sqrt(mean_square * std::exp(quantile * deviation / mean_square))
                           : mean_square;
}

RelativeError estimate_relative_error(const FilmSums& film) {
    if (!has_both_halves(film)) return {INFINITY, 0};
    glm::dvec3 image_mean(0);
    for (const FilmPixel& p : film.pixels) image_mean += mean(film, p) / double(film.pixels.size());
    const Neighbourhoods near(film.width, film.height);
    double sum = 0, squares = 0;
    std::vector<double> contributions(film.pixels.size());
    for (int c = 0; c < 3; ++c) {
        const Plane bias = film.bias.empty() ? Plane(film.pixels.size()) : squared_bias(near, film, c);
        const double floor = std::max(0.01 * image_mean[c] * image_mean[c], 1e-300);
        for (size_t i = 0; i < film.pixels.size(); ++i) {
            const Variance v = variance(film, film.pixels[i], c);
            // The product of the halves has truth² for mean: the square of the mean would be too large, most
            // in the pixels that happen to be too bright.
            const double truth = std::max(0.0, v.even_mean * v.odd_mean);
            contributions[i] += (v.halves + double(bias[i])) / (truth + floor) / 3;
        }
    }
    const double pixels = double(film.pixels.size());
    for (const double q : contributions) sum += q / pixels, squares += q * q / (pixels * pixels);
    // Pixels are independent, so the variance of a sum over them is at most the sum of squares. A pixel's
    // squared difference of halves is distributed as its squared error is: the true relMSE varies as much as
    // the estimate does, and independently of it.
    return {sum, std::sqrt(2 * squares)};
}

}  // namespace etendue
