// Statistical tests with a stated probability of false alarm.
//
// A suite that makes `tests` independent tests and may fail by chance with probability `alpha` as a whole
// compares each p-value with sidak_level(alpha, tests).
#pragma once
#include <cstddef>
#include <span>

namespace etendue {

double normal_survival(double z);            // P(Z > z) for a standard normal Z
double normal_quantile(double p);            // z with P(Z <= z) = p, 0 < p < 1
double chi2_survival(double x, double dof);  // P(X > x) for X chi-squared with `dof` degrees of freedom
double chi2_quantile(double p, double dof);  // x with P(X <= x) = p, 0 < p < 1

// Significance level of each of `tests` independent tests so that all of them together raise a false alarm
// with probability `alpha` (Šidák 1967).
double sidak_level(double alpha, size_t tests);

struct ChiSquared {
    double statistic = 0.0;
    size_t degrees = 0;    // of freedom, after pooling
    double p_value = 1.0;  // 0 where a cell that cannot be reached was
};

// Pearson's test of counts against their expected values. Cells expecting less than `min_expected` are pooled
// with the next smallest. The two need not have the same sum exactly (`expected` may come from quadrature);
// both should hold every sample, with one cell for those that fall nowhere, since one degree of freedom is
// taken away for the sum.
ChiSquared chi_squared_test(std::span<const double> observed, std::span<const double> expected,
                            double min_expected = 5.0);

// Running mean and variance (Welford 1962).
struct Moments {
    double count = 0.0, mean = 0.0, sum_of_squares = 0.0;  // sum_of_squares: of the deviations from the mean
    void add(double x);
    double variance() const;        // of one sample, unbiased
    double standard_error() const;  // of the mean
};

// Two-sided p-value of `value` being `expected`, given its standard error. `tolerance` is a deviation allowed
// besides (quadrature, rounding).
double z_test(double value, double expected, double standard_error, double tolerance = 0.0);

}  // namespace etendue
