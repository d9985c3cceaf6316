#include "host/spectra/color.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "host/spectra/library.h"

namespace etendue {
namespace {

constexpr double lumens_a_watt = 683;

struct Observer {
    std::array<glm::dvec3, spectrum_samples> xyz, rgb, factor;
    SpectralTable white;
    glm::dmat3 xyz_from_rgb;

    Observer() {
        const SpectralTable x = library_table("CIE 1931 x", Outside::zero),
                            y = library_table("CIE 1931 y", Outside::zero),
                            z = library_table("CIE 1931 z", Outside::zero);
        white = library_table("illuminant D65", Outside::zero);
        glm::dvec3 sum(0);
        for (int i = 0; i < spectrum_samples; ++i) {
            xyz[i] = lumens_a_watt * glm::dvec3(x.values[i], y.values[i], z.values[i]);
            sum += xyz[i] * double(white.values[i]);
        }
        white = white * (1 / sum.y);
        // From the chromaticities of the primaries of BT.709-6 and of the white.
        const glm::dmat3 primaries(glm::dvec3(0.64, 0.33, 0.03), glm::dvec3(0.30, 0.60, 0.10),
                                   glm::dvec3(0.15, 0.06, 0.79));
        const glm::dvec3 scale = glm::inverse(primaries) * (sum / sum.y);
        xyz_from_rgb = glm::dmat3(primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z);
        const glm::dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
        for (int i = 0; i < spectrum_samples; ++i) {
            rgb[i] = rgb_from_xyz * xyz[i];
            factor[i] = rgb[i] * double(white.values[i]);
        }
    }
};

const Observer& observer() {
    static const Observer instance;
    return instance;
}

glm::dvec3 weighted_sum(const SpectralTable& s, const std::array<glm::dvec3, spectrum_samples>& weights) {
    glm::dvec3 sum(0);
    for (int i = 0; i < spectrum_samples; ++i) sum += double(s.values[i]) * weights[i];
    return sum;
}

double place(int i) { return double(i) / (spectrum_samples - 1); }

// Every fifth nanometre, which is enough of what is smooth: where, and the weight there.
struct CoarseObserver {
    static constexpr int step = 5, samples = (spectrum_samples - 1) / step + 1;
    static_assert((samples - 1) * step == spectrum_samples - 1);
    std::array<double, samples> t;
    std::array<glm::dvec3, samples> weight;

    CoarseObserver() {
        for (int i = 0; i < samples; ++i) {
            const bool is_end = i == 0 || i == samples - 1;
            t[i] = place(i * step);
            weight[i] = observer().factor[i * step] * (is_end ? 0.25 * step : 0.5 * step);
        }
    }
};

// The colour of a smooth spectrum under D65, and how it changes with the coefficients (columns).
glm::dvec3 smooth_color(const glm::dvec3& c, glm::dmat3& derivative) {
    static const CoarseObserver at;
    glm::dvec3 color(0), by_x(0), by_y(0), by_z(0);  // not behind a reference: they stay in registers
    for (int i = 0; i < at.samples; ++i) {
        const double t = at.t[i], x = (c.x * t + c.y) * t + c.z, r = 1 / std::sqrt(1 + x * x);
        const glm::dvec3 slope = at.weight[i] * (r * r * r);
        color += at.weight[i] * (1 + x * r);
        by_x += slope * (t * t), by_y += slope * t, by_z += slope;
    }
    derivative = glm::dmat3(by_x, by_y, by_z);
    return color;
}

bool is_grey(const glm::dvec3& rgb) { return rgb.x == rgb.y && rgb.y == rgb.z; }

}  // namespace

glm::dvec3 xyz_of_radiance(const SpectralTable& radiance) { return weighted_sum(radiance, observer().xyz); }
glm::dvec3 rgb_of_radiance(const SpectralTable& radiance) { return weighted_sum(radiance, observer().rgb); }
glm::dvec3 xyz_of_rgb(const glm::dvec3& rgb) { return observer().xyz_from_rgb * rgb; }
glm::dvec3 rgb_of_xyz(const glm::dvec3& xyz) { return glm::inverse(observer().xyz_from_rgb) * xyz; }

double luminance(const glm::dvec3& rgb) { return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)); }
const std::array<glm::dvec3, spectrum_samples>& rgb_weights() { return observer().rgb; }
const SpectralTable& white_light() { return observer().white; }

glm::dvec3 rgb_of_factor(const SpectralTable& factor) {
    glm::dvec3 rgb = weighted_sum(factor, observer().factor);
    if (factor.least() >= 0) rgb = glm::max(rgb, 0.0);
    if (factor.greatest() <= 1) rgb = glm::min(rgb, 1.0);
    return rgb;
}

// Levenberg-Marquardt.
glm::dvec3 fit_smooth_spectrum(const glm::dvec3& rgb, const glm::dvec3& start) {
    glm::dvec3 c = start;
    glm::dmat3 j;
    glm::dvec3 residual = smooth_color(c, j) - rgb;
    double damping = 1e-3;
    for (int i = 0; i < 100 && glm::dot(residual, residual) > 1e-12; ++i) {
        glm::dmat3 normal = glm::transpose(j) * j;
        for (int k = 0; k < 3; ++k) normal[k][k] *= 1 + damping, normal[k][k] += 1e-14;
        const glm::dvec3 next = c - glm::inverse(normal) * (glm::transpose(j) * residual);
        glm::dmat3 next_j;
        const glm::dvec3 next_residual = smooth_color(next, next_j) - rgb;
        const double before = glm::dot(residual, residual), after = glm::dot(next_residual, next_residual);
        if (after < before) {
            c = next, j = next_j, residual = next_residual, damping *= 0.2;
            if (before - after < 1e-7 * before) break;
        } else {
            damping *= 8;
            if (damping > 1e12) break;
        }
    }
    return c;
}

SpectralTable smooth_spectrum(const glm::dvec3& c) {
    SpectralTable table;
    for (int i = 0; i < spectrum_samples; ++i) {
        const double t = place(i);
        const double x = (c.x * t + c.y) * t + c.z;
        table.values[i] = float(0.5 + 0.5 * x / std::sqrt(1 + x * x));
    }
    return table;
}

const std::vector<glm::vec4>& color_spectra() {
    static const std::vector<glm::vec4> lattice = [] {
        constexpr int n = color_lattice;
        std::vector<glm::vec4> points(3 * n * n * n);
        const auto fill_columns = [&](int channel) {
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    glm::dvec3 ratios;
                    ratios[channel] = 1;
                    ratios[(channel + 1) % 3] = double(x) / (n - 1),
                                           ratios[(channel + 2) % 3] = double(y) / (n - 1);
                    // From the middle both ways, each fit from its neighbour's.
                    glm::dvec3 middle(0);
                    for (int k = 0; k < n; ++k) {
                        const int z = k < n / 2 ? n / 2 + k : n - 1 - k;
                        const double level = std::clamp(double(z) / (n - 1), 0.02, 1.0);
                        const double g = level < 0.5 ? 2 * level * level : 1 - 2 * (1 - level) * (1 - level);
                        if (k == n / 2) middle = glm::dvec3(points[((channel * n + n / 2) * n + y) * n + x]);
                        middle = fit_smooth_spectrum(ratios * g, middle);
                        points[((channel * n + z) * n + y) * n + x] = glm::vec4(middle, 0);
                    }
                }
        };
        std::vector<std::jthread> threads;
        for (int channel = 0; channel < 3; ++channel) threads.emplace_back(fill_columns, channel);
        threads.clear();
        return points;
    }();
    return lattice;
}

double even_luminance() {
    static const double luminance = xyz_of_radiance(constant_spectrum(1)).y;
    return luminance;
}

SpectralTable factor_of_rgb(const glm::dvec3& rgb) {
    if (is_grey(rgb)) return constant_spectrum(rgb.x);
    // Beyond one twice the greatest channel: near it spectra are bent more than the colour needs (pbrt-v4).
    const double greatest = std::max({rgb.x, rgb.y, rgb.z}), scale = greatest > 1 ? 2 * greatest : 1;
    const glm::dvec3 target = glm::clamp(rgb / scale, 0.0, 1.0);
    // From grey to the colour in steps: a fit that starts far away may end in the wrong valley.
    const double mean = std::clamp((target.x + target.y + target.z) / 3, 0.02, 0.98);
    glm::dvec3 c(0, 0, (mean - 0.5) / std::sqrt(mean * (1 - mean)));
    constexpr int steps = 8;
    for (int i = 1; i <= steps; ++i)
        c = fit_smooth_spectrum(glm::mix(glm::dvec3(mean), target, double(i) / steps), c);
    return smooth_spectrum(c) * scale;
}

SpectralTable radiance_of_rgb(const glm::dvec3& rgb) {
    if (is_grey(rgb)) return white_light() * rgb.x;
    const double scale = 2 * std::max({rgb.x, rgb.y, rgb.z});
    return white_light() * factor_of_rgb(rgb / scale) * scale;
}

}  // namespace etendue
