#include "host/bench/statistics.h"

#include <cmath>
#include <limits>

namespace etendue {

std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y) {
    const size_t n = x.size();
    if (n < 3) return std::nullopt;
    double mean_x = 0, mean_y = 0;
    for (size_t i = 0; i < n; ++i) mean_x += x[i] / double(n), mean_y += y[i] / double(n);
    double xx = 0, xy = 0;
    for (size_t i = 0; i < n; ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (xx <= 0) return std::nullopt;
    LineFit fit;
    fit.slope = xy / xx;
    fit.intercept = mean_y - fit.slope * mean_x;
    double residuals = 0;
    for (size_t i = 0; i < n; ++i) residuals += std::pow(y[i] - fit.intercept - fit.slope * x[i], 2);
    fit.slope_error = std::sqrt(residuals / double(n - 2) / xx);
    return fit;
}

Mean weighted_mean(std::span<const double> values, std::span<const double> weights) {
    double sum = 0, weight = 0;
    for (size_t i = 0; i < values.size(); ++i) sum += weights[i] * values[i], weight += weights[i];
    Mean mean{sum / weight, std::numeric_limits<double>::infinity()};
    if (values.size() < 2) return mean;
    double scatter = 0;
    for (size_t i = 0; i < values.size(); ++i) scatter += weights[i] * std::pow(values[i] - mean.value, 2);
    mean.error = std::sqrt(scatter / double(values.size() - 1) / weight);
    return mean;
}

Crossing find_crossing(std::span<const CurvePoint> curve, double target) {
    size_t below = curve.size();  // from here on the curve stays at or below the target
    while (below > 0 && curve[below - 1].y <= target) --below;
    if (below == curve.size()) return {Crossing::Kind::after_last, curve.back().x};
    if (below == 0) return {Crossing::Kind::before_first, curve.front().x};
    const CurvePoint &a = curve[below - 1], &b = curve[below];
    const double part = std::log(a.y / target) / std::log(a.y / b.y);
    return {Crossing::Kind::between, a.x * std::pow(b.x / a.x, part)};
}

}  // namespace etendue
