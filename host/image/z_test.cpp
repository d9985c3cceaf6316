// The statistical half of compare.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/image/compare.h"

namespace etendue {
namespace {

// Continued fraction of the incomplete beta function (DLMF 8.17.22), evaluated by Lentz's method.
double beta_fraction(double a, double b, double x) {
    const double tiny = 1e-300;
    auto away_from_zero = [&](double v) { return std::abs(v) < tiny ? tiny : v; };
    double c = 1.0, d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)), value = d;
    for (int m = 1; m < 1000; ++m) {
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1.0 / away_from_zero(1.0 + even * d), c = away_from_zero(1.0 + even / c), value *= d * c;
        double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1.0 / away_from_zero(1.0 + odd * d), c = away_from_zero(1.0 + odd / c), value *= d * c;
        if (std::abs(d * c - 1.0) < 1e-14) break;
    }
    return value;
}

// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a
                                     : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

// Degrees of freedom of an image's standard errors: passes - 1, infinite where the image does not tell.
double error_dof(const Image& image) {
    auto found = image.attributes.find("passes");
    if (found == image.attributes.end()) return std::numeric_limits<double>::infinity();
    const double* passes = std::get_if<double>(&found->second);
    return passes && *passes >= 2 ? *passes - 1 : std::numeric_limits<double>::infinity();
}

struct TileMean {
    double difference = 0;         // mean(I) - mean(R)
    double variance = 0;           // of the difference
    double weighted_variance = 0;  // sum of the variances' squares over their degrees of freedom (Welch 1947)
    double magnitude = 0;
    bool finite = true;
};

}  // namespace

double student_two_sided(double t, double dof) {
    t = std::abs(t);
    if (dof > 1e7) return std::erfc(t / std::sqrt(2.0));
    if (std::isinf(t)) return 0;
    return incomplete_beta(0.5 * dof, 0.5, dof / (dof + t * t));
}

std::optional<ZTest> z_test(const Image& image, const Image& reference,
                            const std::vector<std::string>& channels, uint32_t tile, double alpha) {
    struct Channel {
        std::span<const float> a, b, error_a, error_b;
    };
    std::vector<Channel> selected;
    for (const std::string& name : channels) {
        int a = find_channel(image, name), b = find_channel(reference, name);
        int error_a = find_channel(image, "error." + name),
            error_b = find_channel(reference, "error." + name);
        if (a < 0 || b < 0 || error_a < 0 || error_b < 0) return std::nullopt;
        selected.push_back({plane(image, size_t(a)), plane(reference, size_t(b)),
                            plane(image, size_t(error_a)), plane(reference, size_t(error_b))});
    }
    double dof_a = error_dof(image), dof_b = error_dof(reference);

    auto mean_of_tile = [&](const Channel& channel, uint32_t x0, uint32_t y0) {
        TileMean mean;
        double count = 0;
        for (uint32_t y = y0; y < std::min(y0 + tile, image.height); ++y)
            for (uint32_t x = x0; x < std::min(x0 + tile, image.width); ++x) {
                size_t p = size_t(y) * image.width + x;
                double a = channel.a[p], b = channel.b[p];
                double va = double(channel.error_a[p]) * channel.error_a[p];
                double vb = double(channel.error_b[p]) * channel.error_b[p];
                mean.difference += a - b, mean.variance += va + vb,
                    mean.magnitude += std::abs(a) + std::abs(b);
                mean.weighted_variance += va * va / dof_a + vb * vb / dof_b;
                mean.finite = mean.finite && std::isfinite(a) && std::isfinite(b) && std::isfinite(va + vb);
                count += 1;
            }
        mean.difference /= count, mean.magnitude /= count;
        mean.variance /= count * count, mean.weighted_variance /= count * count * count * count;
        return mean;
    };

    ZTest result;
    result.p_value = 1;
    size_t beyond = 0;
    double sum_squared = 0;
    for (const Channel& channel : selected)
        for (uint32_t y = 0; y < image.height; y += tile)
            for (uint32_t x = 0; x < image.width; x += tile) {
                TileMean mean = mean_of_tile(channel, x, y);
                if (!mean.finite) continue;
                // Values without noise may still differ by the rounding of their float sums.
                double rounding = 1e-6 * mean.magnitude;
                double sigma = std::sqrt(mean.variance + rounding * rounding);
                double z = mean.difference == 0 ? 0 : std::abs(mean.difference) / sigma;
                double dof = mean.weighted_variance > 0
                                 ? mean.variance * mean.variance / mean.weighted_variance
                                 : std::numeric_limits<double>::infinity();
                ++result.tests;
                beyond += z > 3, sum_squared += z * z;
                if (z > result.max_z) result.max_z = z, result.x = x, result.y = y;
                if (z > 2) result.p_value = std::min(result.p_value, student_two_sided(z, dof));
            }
    if (result.tests == 0) return result;
    result.beyond_3 = double(beyond) / double(result.tests);
    result.rms_z = std::sqrt(sum_squared / double(result.tests));
    result.p_limit = -std::expm1(std::log1p(-alpha) / double(result.tests));
    result.passes = result.p_value >= result.p_limit;
    return result;
}

}  // namespace etendue
