// Statistics of error against effort.
#pragma once
#include <optional>
#include <span>

namespace etendue {

struct LineFit {
    double slope = 0, intercept = 0;
    double slope_error = 0;  // standard error, from the scatter about the line
};

// Least squares for y = intercept + slope x, of points that are independent of each other. nullopt below
// three points and where all x are equal.
std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y);

struct Mean {
    double value = 0;
    double error = 0;  // standard error; infinite for a single value
};

// The mean of values whose variances are in proportion to 1 / weight.
Mean weighted_mean(std::span<const double> values, std::span<const double> weights);

struct CurvePoint {
    double x = 0, y = 0;  // above 0
};

// Where a curve falls to `target` and stays there. x is interpolated in logarithms of both; it is that of the
// first point where the curve begins below, and of the last where it ends above.
struct Crossing {
    enum class Kind { before_first, between, after_last } kind = Kind::after_last;
    double x = 0;
};
Crossing find_crossing(std::span<const CurvePoint> curve, double target);  // at least one point, x ascending

}  // namespace etendue
