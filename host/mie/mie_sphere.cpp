#include "host/mie/mie_sphere.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue {
namespace {

using Complex = std::complex<double>;

// Wiscombe 1980, equation 22.
size_t term_count(double x) {
    const double root = std::cbrt(x);
    return size_t(x <= 8 ? x + 4 * root + 2 : x <= 4200 ? x + 4.05 * root + 3 : x + 4 * root + 3);
}

// ψn'(z) / ψn(z) for n = 1 to `count`, by downward recurrence, which is stable for all z.
std::vector<Complex> logarithmic_derivatives(Complex z, size_t count) {
    const size_t start = std::max(count, size_t(std::abs(z))) + 16;
    std::vector<Complex> result(count);
    Complex d = 0;
    for (size_t n = start; n > 1; --n) {
        const Complex ratio = double(n) / z;
        d = ratio - 1.0 / (d + ratio);
        if (n - 1 <= count) result[n - 2] = d;
    }
    return result;
}

}  // namespace

MieCoefficients mie_coefficients(double x, Complex m) {
    const size_t count = term_count(x);
    const std::vector<Complex> derivatives = logarithmic_derivatives(m * x, count);
    MieCoefficients result;
    result.a.reserve(count), result.b.reserve(count);
    // ψ and χ of Riccati and Bessel, upward: n - 1 and n.
    double psi[2] = {std::cos(x), std::sin(x)}, chi[2] = {-std::sin(x), std::cos(x)};
    for (size_t n = 1; n <= count; ++n) {
        const double step = (2.0 * double(n) - 1) / x;
        psi[0] = std::exchange(psi[1], step * psi[1] - psi[0]);
        chi[0] = std::exchange(chi[1], step * chi[1] - chi[0]);
        const Complex xi(psi[1], chi[1]), xi_before(psi[0], chi[0]);
        const Complex electric = derivatives[n - 1] / m + double(n) / x;
        const Complex magnetic = derivatives[n - 1] * m + double(n) / x;
        result.a.push_back((electric * psi[1] - psi[0]) / (electric * xi - xi_before));
        result.b.push_back((magnetic * psi[1] - psi[0]) / (magnetic * xi - xi_before));
    }
    return result;
}

double extinction_efficiency(const MieCoefficients& c, double x) {
    double sum = 0;
    for (size_t i = 0; i < c.a.size(); ++i) sum += (2.0 * double(i) + 3) * (c.a[i] + c.b[i]).real();
    return 2 * sum / (x * x);
}

double scattering_efficiency(const MieCoefficients& c, double x) {
    double sum = 0;
    for (size_t i = 0; i < c.a.size(); ++i)
        sum += (2.0 * double(i) + 3) * (std::norm(c.a[i]) + std::norm(c.b[i]));
    return 2 * sum / (x * x);
}

MieElements elements_of(Complex sum, Complex difference) {
    const double p = std::norm(sum), q = std::norm(difference);
    const Complex product = sum * std::conj(difference);
    return {(p + q) / 4, product.real() / 2, (p - q) / 4, product.imag() / 2};
}

MieElements mie_elements(const MieCoefficients& c, double cosine) {
    Complex across = 0, along = 0;  // S1, S2
    double pi = 0, next_pi = 1;
    for (size_t n = 1; n <= c.a.size(); ++n) {
        const double k = double(n), tau = k * cosine * next_pi - (k + 1) * pi;
        const double factor = (2 * k + 1) / (k * (k + 1));
        across += factor * (c.a[n - 1] * next_pi + c.b[n - 1] * tau);
        along += factor * (c.a[n - 1] * tau + c.b[n - 1] * next_pi);
        pi = std::exchange(next_pi, ((2 * k + 1) * cosine * next_pi - (k + 1) * pi) / k);
    }
    return elements_of(across + along, across - along);
}

}  // namespace etendue
