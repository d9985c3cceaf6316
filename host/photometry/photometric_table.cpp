#include "host/photometry/photometric_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/error.h"

namespace etendue {
namespace {

constexpr double degree = std::numbers::pi / 180;

// Cosine of the angle from -z beyond which all is dark; -1 where the poles are elsewhere.
double lit_cosine(const IntensityDistribution& d) {
    if (d.type != IntensityDistribution::Type::c) return -1;
    size_t dark = d.angles.size();  // the first of the angles from which on all is dark
    const auto is_dark = [&](size_t angle) {
        for (size_t p = 0; p < d.planes.size(); ++p)
            if (d.at(p, angle) > 0) return false;
        return true;
    };
    while (dark > 0 && is_dark(dark - 1)) --dark;
    return std::cos(d.angles[std::min(dark, d.angles.size() - 1)] * degree + 1e-4);
}

uint32_t shape_of(LuminousOpening::Kind kind) {
    using Kind = LuminousOpening::Kind;
    switch (kind) {
        case Kind::point:
            return 0;
        case Kind::rectangle:
        case Kind::box:
            return 1;
        case Kind::disk:
        case Kind::ellipse:
        case Kind::cylinder:
            return 2;
        case Kind::sphere:
            return 3;
    }
    return 0;
}

}  // namespace

PhotometryRef append_photometric_table(std::vector<float>& values, const IntensityDistribution& d) {
    IntensityDistribution closed = d;
    if (d.planes.size() == 1) {
        closed.planes = {0, 360};
        closed.candela.insert(closed.candela.end(), d.candela.begin(), d.candela.end());
    }
    const std::vector<double>& planes = closed.planes;
    const size_t angles = d.angles.size();
    if (values.size() + 2 * angles + planes.size() * (1 + 2 * angles) >= 1u << 31)
        fail_input("photometric files with more than 2^31 numbers together");
    const double flux = d.flux(), start = planes[0];
    const PhotometryRef ref{uint32_t(values.size()),
                            uint32_t(planes.size()),
                            uint32_t(angles),
                            uint32_t(d.type),
                            float(start * degree),
                            float(flux),
                            float(std::max(lit_cosine(d), -1.0)),
                            shape_of(d.opening.kind),
                            uint32_t(d.opening.axis),
                            glm::vec3(d.opening.size)};
    for (const double angle : d.angles) values.push_back(float(angle * degree));
    double below = 0;
    for (size_t j = 0; j < angles; ++j) {
        values.push_back(j + 1 == angles ? 1.0f : float(flux > 0 ? below / flux : 0));
        if (j + 1 < angles) below += d.ring_flux(j);
    }
    for (const double plane : planes) values.push_back(float((plane - start) * degree));
    for (size_t j = 0; j < angles; ++j)
        for (size_t p = 0; p < planes.size(); ++p) values.push_back(float(closed.at(p, j)));
    for (size_t j = 0; j < angles; ++j) {
        double sum = 0;
        for (size_t p = 0; p < planes.size(); ++p) {
            if (p > 0)
                sum += (planes[p] - planes[p - 1]) * degree * 0.5 * (closed.at(p - 1, j) + closed.at(p, j));
            values.push_back(float(sum));
        }
    }
    return ref;
}

std::string photometric_summary(const IntensityDistribution& d) {
    return fmt::format("{:.6g} lm, peak {:.6g} cd, opening {}", d.flux(), d.peak(), opening_text(d.opening));
}

}  // namespace etendue
