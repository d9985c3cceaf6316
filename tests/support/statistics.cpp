#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace etendue {

namespace {

// Regularized upper incomplete gamma function Q(a, x): series for x < a + 1, Lentz's continued fraction
// beyond (Abramowitz & Stegun 6.5.29, 6.5.31). Relative accuracy about 1e-14, kept in the far tail.
double gamma_q(double a, double x) {
    if (!(x > 0.0)) return 1.0;
    double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
    const int max_terms = 100000;
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < max_terms && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
        return 1.0 - scale * sum;
    }
    const double tiny = 1e-300;
    double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, h = d;
    for (int n = 1; n < max_terms; ++n) {
        double numerator = -n * (n - a);
        b += 2.0;
        d = numerator * d + b;
        if (std::abs(d) < tiny) d = tiny;
        c = b + numerator / c;
        if (std::abs(c) < tiny) c = tiny;
        d = 1.0 / d;
        h *= d * c;
        if (std::abs(d * c - 1.0) < 1e-15) break;
    }
    return scale * h;
}

// The x in [lo, hi] where a falling function crosses zero.
template <class F>
double bisect_falling(F&& f, double lo, double hi) {
    for (int i = 0; i < 200; ++i) {
        double mid = 0.5 * (lo + hi);
        if (mid == lo || mid == hi) break;
        (f(mid) > 0.0 ? lo : hi) = mid;
    }
    return 0.5 * (lo + hi);
}

}  // namespace

double normal_survival(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

double normal_quantile(double p) {
    if (p > 0.5) return bisect_falling([&](double z) { return normal_survival(z) - (1.0 - p); }, 0.0, 40.0);
    return -bisect_falling([&](double z) { return normal_survival(z) - p; }, 0.0, 40.0);
}

double chi2_survival(double x, double dof) {
    return dof > 0.0 ? gamma_q(0.5 * dof, 0.5 * x) : (x > 0.0 ? 0.0 : 1.0);
}

double chi2_quantile(double p, double dof) {
    double hi = std::max(1.0, 2.0 * dof);
    while (chi2_survival(hi, dof) > 1.0 - p) hi *= 2.0;
    return bisect_falling([&](double x) { return chi2_survival(x, dof) - (1.0 - p); }, 0.0, hi);
}

double sidak_level(double alpha, size_t tests) {
    return -std::expm1(std::log1p(-alpha) / double(std::max<size_t>(tests, 1)));
}

ChiSquared chi_squared_test(std::span<const double> observed, std::span<const double> expected,
                            double min_expected) {
    ChiSquared result;
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return expected[a] < expected[b]; });

    // Small cells are gathered until they expect enough; what is left at the end joins the last cell.
    std::vector<double> pooled_observed, pooled_expected;
    double o = 0.0, e = 0.0;
    for (size_t i : order) {
        if (!std::isfinite(expected[i]) || expected[i] < 0.0)
            return {std::numeric_limits<double>::infinity(), 0, 0.0};
        o += observed[i], e += expected[i];
        if (e >= min_expected) {
            pooled_observed.push_back(o), pooled_expected.push_back(e);
            o = e = 0.0;
        }
    }
    if (pooled_expected.empty()) {
        // Too few samples to say anything, except where nothing at all may arrive.
        if (e == 0.0 && o > 0.0) result.p_value = 0.0;
        return result;
    }
    pooled_observed.back() += o, pooled_expected.back() += e;

    // Samples where none can fall are hidden by pooling when there are few of them; look at them by
    // themselves.
    for (size_t i = 0; i < expected.size(); ++i)
        if (expected[i] == 0.0 && observed[i] > 0.0) result.p_value = 0.0;

    for (size_t i = 0; i < pooled_expected.size(); ++i) {
        double d = pooled_observed[i] - pooled_expected[i];
        result.statistic += d * d / pooled_expected[i];
    }
    result.degrees = pooled_expected.size() - 1;
    if (result.p_value > 0.0) {
        // A single cell has no freedom left: it only has to hold what it should, to the accuracy of the
        // quadrature.
        if (result.degrees == 0)
            result.p_value =
                std::abs(pooled_observed[0] - pooled_expected[0]) <= 1e-3 * pooled_expected[0] ? 1.0 : 0.0;
        else
            result.p_value = chi2_survival(result.statistic, double(result.degrees));
    }
    return result;
}

void Moments::add(double x) {
    count += 1.0;
    double d = x - mean;
    mean += d / count;
    sum_of_squares += d * (x - mean);
}

double Moments::variance() const { return count > 1.0 ? sum_of_squares / (count - 1.0) : 0.0; }
double Moments::standard_error() const { return count > 0.0 ? std::sqrt(variance() / count) : 0.0; }

double z_test(double value, double expected, double standard_error, double tolerance) {
    double d = std::abs(value - expected) - tolerance;
    if (std::isnan(d)) return 0.0;
    if (d <= 0.0) return 1.0;
    if (!(standard_error > 0.0)) return 0.0;
    return 2.0 * normal_survival(d / standard_error);
}

}  // namespace etendue
