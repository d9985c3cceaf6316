#include "host/spectra/spectrum.h"

#include <algorithm>
#include <cmath>

namespace etendue {

double SpectralTable::at(double nm) const {
    const double x = std::clamp(nm - first_nm, 0.0, double(spectrum_samples - 1));
    const int i = std::min(int(x), spectrum_samples - 2);
    return std::lerp(double(values[i]), double(values[i + 1]), x - i);
}

float SpectralTable::least() const { return *std::min_element(values.begin(), values.end()); }
float SpectralTable::greatest() const { return *std::max_element(values.begin(), values.end()); }

SpectralTable tabulate(const std::function<double(double)>& f) {
    SpectralTable table;
    for (int i = 0; i < spectrum_samples; ++i) table.values[i] = float(f(first_nm + i));
    return table;
}

SpectralTable constant_spectrum(double value) {
    SpectralTable table;
    table.values.fill(float(value));
    return table;
}

SpectralTable operator*(const SpectralTable& a, const SpectralTable& b) {
    SpectralTable product;
    for (int i = 0; i < spectrum_samples; ++i) product.values[i] = a.values[i] * b.values[i];
    return product;
}

SpectralTable operator*(const SpectralTable& a, double b) { return a * constant_spectrum(b); }

SpectralTable interpolate(std::span<const double> nm, std::span<const double> values, Outside outside) {
    return tabulate([&](double x) {
        if (x < nm.front() || x > nm.back())
            return outside == Outside::zero ? 0.0 : x < nm.front() ? values.front() : values.back();
        const size_t next = size_t(std::upper_bound(nm.begin(), nm.end(), x) - nm.begin());
        if (next == nm.size()) return values.back();
        return std::lerp(values[next - 1], values[next], (x - nm[next - 1]) / (nm[next] - nm[next - 1]));
    });
}

double blackbody_radiance(double kelvin, double nm) {
    constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    const double m = nm * 1e-9;
    return 1e-9 * 2 * h * c * c / (std::pow(m, 5) * std::expm1(h * c / (m * k * kelvin)));
}

double cauchy_index(std::span<const double> coefficients, double nm) {
    const double inverse = 1e6 / (nm * nm);
    double n = 0;
    for (size_t i = coefficients.size(); i-- > 0;) n = n * inverse + coefficients[i];
    return n;
}

double sellmeier_index(std::span<const double> coefficients, double nm) {
    const double square = nm * nm * 1e-6;
    const size_t terms = coefficients.size() / 2;
    double n2 = 1;
    for (size_t i = 0; i < terms; ++i) n2 += coefficients[i] * square / (square - coefficients[terms + i]);
    return std::sqrt(n2);
}

}  // namespace etendue
