// Spectra as the host keeps them: a value at every nanometre of the visible range, linear in between.
#pragma once
#include <array>
#include <functional>
#include <span>

namespace etendue {

constexpr int first_nm = 360, last_nm = 830;
constexpr int spectrum_samples = last_nm - first_nm + 1;

struct SpectralTable {
    std::array<float, spectrum_samples> values{};

    double at(double nm) const;  // nm is clamped to the range
    float least() const, greatest() const;
    bool operator==(const SpectralTable&) const = default;
};

SpectralTable tabulate(const std::function<double(double nm)>& f);
SpectralTable constant_spectrum(double value);
SpectralTable operator*(const SpectralTable& a, const SpectralTable& b);
SpectralTable operator*(const SpectralTable& a, double b);

enum class Outside { hold, zero };  // what holds beyond the ends of a table

// Linear between points; `nm` rises strictly and has the size of `values`, at least 1.
SpectralTable interpolate(std::span<const double> nm, std::span<const double> values, Outside outside);

// Planck's law, W / (m² sr nm), with the constants of the SI (2019).
double blackbody_radiance(double kelvin, double nm);

// n = A + B/λ² + C/λ⁴ + …, λ in µm.
double cauchy_index(std::span<const double> coefficients, double nm);
// n² = 1 + Σ Bᵢ λ² / (λ² - Cᵢ), λ in µm; the Bᵢ first, then as many Cᵢ in µm². Not a number where n² < 0.
double sellmeier_index(std::span<const double> coefficients, double nm);

}  // namespace etendue
