#include "host/spectra/wavelengths.h"

#include <algorithm>
#include <cmath>

#include "host/spectra/color.h"

namespace etendue {
namespace {

constexpr int cells = spectrum_samples - 1;
constexpr double even_part = 0.1;  // of the density, spread over all wavelengths for spectral images

// Mostly in proportion to what daylight contributes to the channels.
struct Distribution {
    std::array<double, cells + 1> sums{};  // of the density up to the beginning of a cell
    Distribution() {
        std::array<double, cells> shares;
        double total = 0;
        for (int i = 0; i < cells; ++i) {
            const glm::dvec3 a = glm::abs(rgb_weights()[i]) * double(white_light().values[i]);
            total += shares[i] = a.x + a.y + a.z;
        }
        for (int i = 0; i < cells; ++i)
            sums[i + 1] = sums[i] + (1 - even_part) * shares[i] / total + even_part / cells;
        for (double& s : sums) s /= sums.back();
    }
    double pdf(int cell) const { return sums[cell + 1] - sums[cell]; }
};

const Distribution& distribution() {
    static const Distribution instance;
    return instance;
}

int cell_of(double nm) { return std::clamp(int(nm) - first_nm, 0, cells - 1); }

double wavelength_at(double u) {
    const auto& sums = distribution().sums;
    const int cell =
        std::clamp(int(std::upper_bound(sums.begin(), sums.end(), u) - sums.begin()) - 1, 0, cells - 1);
    return first_nm + cell + std::clamp((u - sums[cell]) / distribution().pdf(cell), 0.0, 1.0);
}

// splitmix64 (Steele, Lea & Flood 2014, "Fast Splittable Pseudorandom Number Generators").
uint64_t hash(uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// The first two dimensions of Sobol's sequence in 32 bits; the direction numbers of the second are each the
// one before, shifted and added to itself.
glm::uvec2 sobol(uint32_t index) {
    glm::uvec2 point(0);
    uint32_t second = 1u << 31;
    for (int bit = 0; bit < 32; ++bit, second ^= second >> 1)
        if (index >> bit & 1) point.x ^= 1u << (31 - bit), point.y ^= second;
    return point;
}

}  // namespace

double wavelength_pdf(double nm) { return distribution().pdf(cell_of(nm)); }

// Two numbers, stratified together: where within a quarter the four lie, and in which quarter the first is. So
// both the four and each path's hero alone are spread evenly over the passes.
Wavelengths choose_wavelengths(uint64_t pass, uint32_t seed) {
    const uint64_t shift = hash(uint64_t(seed) << 1 | (pass & 1));
    const glm::uvec2 point = sobol(uint32_t(pass >> 1)) ^ glm::uvec2(uint32_t(shift), uint32_t(shift >> 32));
    const double within = point.x / 4294967296.0;
    const uint32_t quarter = point.y >> 30;
    Wavelengths w;
    for (uint32_t lane = 0; lane < 4; ++lane) {
        const double nm = wavelength_at(((quarter + lane) % 4 + within) / 4);
        const double x = nm - first_nm;
        const int i = std::min(int(x), cells - 1);
        const glm::dvec3 weight = glm::mix(rgb_weights()[i], rgb_weights()[i + 1], x - i);
        const double share = 1 / (4 * wavelength_pdf(nm) * even_luminance());
        w.nm[lane] = float(nm);
        w.rgb[lane] = glm::vec3(weight * share);
        w.share[lane] = float(share);
    }
    return w;
}

}  // namespace etendue
