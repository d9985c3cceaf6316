// Means over Stokes images, and what they are to be.
#pragma once
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/support/render_probe.h"

namespace etendue {

using StokesMeans = std::array<WindowMean, 4>;  // of S0 to S3

inline StokesMeans stokes_means(const Estimates& e) {
    const uint32_t height = e.height / 4;
    StokesMeans means;
    for (uint32_t i = 0; i < 4; ++i) means[i] = window_mean(e, {0, height * i, e.width, height});
    return means;
}

inline void check_stokes(const StokesMeans& found, const glm::dvec4& expected, double largest_error = 3e-4,
                         double slack = 1e-5) {
    for (int i = 0; i < 4; ++i) {
        CAPTURE(i);
        CAPTURE(found[i].mean);
        CAPTURE(found[i].standard_error);
        CAPTURE(expected[i]);
        CHECK(std::fabs(found[i].mean - expected[i]) < slack + 5 * found[i].standard_error);
        CHECK(found[i].standard_error < largest_error);
    }
}

}  // namespace etendue
