// Rows of spheres of radius 1 m, one a cell of the image, seen from above before an environment.
#pragma once
#include <cmath>

#include "tests/support/render_probe.h"

namespace etendue {

inline constexpr uint32_t sphere_pixels = 16;  // of a cell's side
inline constexpr double sphere_spacing = 2.2;  // m, a cell's side

// Mean over the pixels of cell `index` that lie within `radius` (m) of its middle, channels divided by those
// of the environment; with its standard error over the seeds.
inline WindowMean disk_albedo(const Estimates& e, size_t index, double radius,
                              const double (&environment)[3]) {
    WindowMean result;
    std::vector<double> means(e.seeds, 0.0);
    double count = 0;
    for (uint32_t y = 0; y < sphere_pixels; ++y)
        for (uint32_t x = 0; x < sphere_pixels; ++x) {
            const double dx = (x + 0.5) / sphere_pixels - 0.5, dy = (y + 0.5) / sphere_pixels - 0.5;
            if (std::hypot(dx, dy) * sphere_spacing > radius) continue;
            const size_t pixel = size_t(y) * e.width + index * sphere_pixels + x;
            for (uint32_t c = 0; c < 3; ++c, ++count)
                for (uint32_t s = 0; s < e.seeds; ++s)
                    means[s] += e.images[s][3 * pixel + c] / environment[c];
        }
    for (double& m : means) m /= count, result.mean += m / e.seeds;
    for (const double m : means)
        result.standard_error += (m - result.mean) * (m - result.mean) / (e.seeds - 1.0) / e.seeds;
    result.standard_error = std::sqrt(result.standard_error);
    return result;
}

}  // namespace etendue
