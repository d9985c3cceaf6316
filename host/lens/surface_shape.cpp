#include "host/lens/surface_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {

double SurfaceShape::reach() const {
    const double k = 1 + conic;
    return curvature != 0 && k > 0 ? 1 / (std::abs(curvature) * std::sqrt(k))
                                   : std::numeric_limits<double>::infinity();
}

double SurfaceShape::vertex_curvature() const {
    return curvature + (coefficients.empty() ? 0 : 2 * coefficients[0]);
}

double SurfaceShape::sag_of(double r2) const {
    const double root = std::sqrt(std::max(0.0, 1 - (1 + conic) * curvature * curvature * r2));
    double polynomial = 0;
    for (size_t i = coefficients.size(); i-- > 0;) polynomial = (polynomial + coefficients[i]) * r2;
    return curvature * r2 / (1 + root) + polynomial;
}

double SurfaceShape::slope_of(double r2) const {
    const double root = std::sqrt(std::max(1e-30, 1 - (1 + conic) * curvature * curvature * r2));
    double polynomial = 0;
    for (size_t i = coefficients.size(); i-- > 0;)
        polynomial = polynomial * r2 + double(i + 1) * coefficients[i];
    return 0.5 * curvature / root + polynomial;
}

double SurfaceShape::sag(double x, double y) const {
    const double r2 = squared_r({x, y, 0});
    if (r2 > reach() * reach() * (1 + 1e-12)) return std::numeric_limits<double>::quiet_NaN();
    return sag_of(r2);
}

glm::dvec3 SurfaceShape::normal(const glm::dvec3& p) const {
    const double x = is_cylinder ? 0 : p.x;
    if (coefficients.empty())  // holds at the equator, too
        return glm::normalize(
            glm::dvec3(-curvature * x, -curvature * p.y, 1 - curvature * (1 + conic) * p.z));
    const double slope = 2 * slope_of(squared_r(p));
    return glm::normalize(glm::dvec3(-slope * x, -slope * p.y, 1));
}

// F = c (r² + (1 + K) z²) - 2 z = 0, as A t² + 2 B t + C = 0, solved without a difference of near numbers. On
// the vertex sheet 1 - c (1 + K) z, the root of the formula for z(r), is not negative.
std::optional<double> SurfaceShape::intersect_conic(const glm::dvec3& o, const glm::dvec3& d) const {
    const double c = curvature, k = 1 + conic, flat = is_cylinder ? 0 : 1;
    const double a = c * (flat * d.x * d.x + d.y * d.y + k * d.z * d.z);
    const double b = c * (flat * o.x * d.x + o.y * d.y + k * o.z * d.z) - d.z;
    const double e = c * (flat * o.x * o.x + o.y * o.y + k * o.z * o.z) - 2 * o.z;
    const double discriminant = b * b - a * e;
    if (!(discriminant >= 0)) return {};
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double t : {e / q, q / a})  // the first is nearer to the axis, that of the plane where c = 0
        if (std::isfinite(t) && 1 - c * k * (o.z + t * d.z) >= -1e-9) return t;
    return {};
}

std::optional<double> SurfaceShape::intersect(const glm::dvec3& origin, const glm::dvec3& d) const {
    // From the point of the line that is nearest to the vertex: starts may be far away.
    const double shift = -glm::dot(origin, d);
    const glm::dvec3 o = origin + shift * d;
    std::optional<double> t = intersect_conic(o, d);
    if (coefficients.empty()) {
        if (t) *t += shift;
        return t;
    }
    // f(t) = z - z(r): a bracket about the conic's crossing, or the plane's, and Newton's steps that stay
    // within it.
    const auto f = [&](double at, double& slope) {
        const glm::dvec3 p = o + at * d;
        const double r2 = squared_r(p), x = is_cylinder ? 0 : p.x;
        slope = d.z - 2 * slope_of(r2) * (x * d.x + p.y * d.y);
        return p.z - sag_of(r2);
    };
    double at = t ? *t : d.z != 0 ? -o.z / d.z : 0;
    double slope, value = f(at, slope), unused;
    double low = at, high = at, low_value = value, high_value = value;
    double step = std::max(1e-9, 2 * std::abs(value / (slope != 0 ? slope : 1)));
    for (int turn = 0; value != 0 && low_value * value > 0 && high_value * value > 0; ++turn, step *= 1.6) {
        if (turn == 60) return {};
        low_value = f(low = at - step, unused), high_value = f(high = at + step, unused);
    }
    if (value != 0) {
        if (low_value * value <= 0)
            high = at, high_value = value;
        else
            low = at, low_value = value;
    }
    for (int turn = 0; turn < 200 && value != 0; ++turn) {
        (value * high_value > 0 ? high : low) = at;
        double next = at - value / slope;
        if (!(next > low && next < high) || turn > 20) next = 0.5 * (low + high);
        if (next == at || high - low < 1e-15 * (1 + std::abs(at))) break;
        at = next, value = f(at, slope);
    }
    if (squared_r(o + at * d) > reach() * reach()) return {};
    return at + shift;
}

}  // namespace etendue
