#include "host/photometry/intensity_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/error.h"
#include "host/photometry/ies_file.h"
#include "host/photometry/ldt_file.h"

namespace etendue {
namespace {

using Type = IntensityDistribution::Type;

constexpr double degree = std::numbers::pi / 180;

// The pole, the longitudes 0 and 90.
glm::dmat3 table_frame(Type type) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), down(0, 0, -1);
    return type == Type::c   ? glm::dmat3(down, x, y)
           : type == Type::b ? glm::dmat3(y, down, x)
                             : glm::dmat3(x, down, y);
}

// Where `value` lies between nodes: value = (1 - part) nodes[index] + part nodes[index + 1]. False: outside.
bool locate(const std::vector<double>& nodes, double value, size_t& index, double& part) {
    // Directions that make the last angle may be rounded beyond it.
    const double slack = 1e-9;
    if (!(value >= nodes.front() - slack && value <= nodes.back() + slack)) return false;
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), value);
    index = size_t(std::clamp<ptrdiff_t>(above - nodes.begin() - 1, 0, ptrdiff_t(nodes.size()) - 2));
    part = std::clamp((value - nodes[index]) / (nodes[index + 1] - nodes[index]), 0.0, 1.0);
    return true;
}

// Integral of sin over [a, b] times what is 1 at a and falls to 0 at b, degrees.
double falling_weight(double a, double b) {
    const double d = (b - a) * degree;
    return std::cos(a * degree) - (std::sin(b * degree) - std::sin(a * degree)) / d;
}
// The same for what rises from 0 at a to 1 at b.
double rising_weight(double a, double b) {
    const double d = (b - a) * degree;
    return (std::sin(b * degree) - std::sin(a * degree)) / d - std::cos(b * degree);
}

}  // namespace

std::string opening_text(const LuminousOpening& o) {
    using Kind = LuminousOpening::Kind;
    const glm::dvec3 s = o.size;
    const int u = o.axis == 0 ? 1 : 0, v = o.axis == 2 ? 1 : 2;
    switch (o.kind) {
        case Kind::point:
            return "point";
        case Kind::rectangle:
            return fmt::format("rectangle {:.4g} x {:.4g} m", s[u], s[v]);
        case Kind::box:
            return fmt::format("box {:.4g} x {:.4g} x {:.4g} m", s.x, s.y, s.z);
        case Kind::disk:
            return fmt::format("disk of diameter {:.4g} m", s[u]);
        case Kind::ellipse:
            return fmt::format("ellipse {:.4g} x {:.4g} m", s[u], s[v]);
        case Kind::cylinder:
            return fmt::format("cylinder {:.4g} m thick, {:.4g} m long", s[u], s[o.axis]);
        case Kind::sphere:
            return fmt::format("sphere of diameter {:.4g} m", s.x);
    }
    return "";
}

double IntensityDistribution::intensity(const glm::dvec3& direction) const {
    const glm::dvec3 d = direction * table_frame(type);
    const double angle = std::atan2(std::hypot(d.y, d.z), d.x) / degree;
    double longitude = std::atan2(d.z, d.y) / degree;
    size_t i = 0, j = 0;
    double x = 0, y = 0;
    if (!locate(angles, angle, j, y)) return 0;
    const auto in_plane = [&](size_t plane) { return (1 - y) * at(plane, j) + y * at(plane, j + 1); };
    if (planes.size() == 1) return in_plane(0);
    while (longitude < planes.front() - 1e-9) longitude += 360;
    while (longitude > planes.back() + 1e-9 && longitude - 360 >= planes.front() - 1e-9) longitude -= 360;
    if (!locate(planes, longitude, i, x)) return 0;
    return (1 - x) * in_plane(i) + x * in_plane(i + 1);
}

double IntensityDistribution::intensity(double c, double gamma) const {
    const double s = std::sin(gamma * degree);
    return intensity({s * std::cos(c * degree), s * std::sin(c * degree), -std::cos(gamma * degree)});
}

double IntensityDistribution::ring_flux(size_t j) const {
    const double a = falling_weight(angles[j], angles[j + 1]), b = rising_weight(angles[j], angles[j + 1]);
    if (planes.size() == 1) return 2 * std::numbers::pi * (a * at(0, j) + b * at(0, j + 1));
    double sum = 0;
    for (size_t i = 0; i + 1 < planes.size(); ++i)
        sum += (planes[i + 1] - planes[i]) * degree / 2 *
               (a * (at(i, j) + at(i + 1, j)) + b * (at(i, j + 1) + at(i + 1, j + 1)));
    return sum;
}

double IntensityDistribution::flux() const {
    double sum = 0;
    for (size_t j = 0; j + 1 < angles.size(); ++j) sum += ring_flux(j);
    return sum;
}

double IntensityDistribution::peak() const { return *std::max_element(candela.begin(), candela.end()); }

IntensityDistribution in_c_planes(const IntensityDistribution& d) {
    if (d.type == Type::c) return d;
    IntensityDistribution result = d;
    result.type = Type::c;
    result.planes.clear(), result.angles.clear(), result.candela.clear();
    for (int c = 0; c <= 360; ++c) result.planes.push_back(c);
    for (int gamma = 0; gamma <= 180; ++gamma) result.angles.push_back(gamma);
    for (const double c : result.planes)
        for (const double gamma : result.angles)
            result.candela.push_back(d.intensity(std::fmod(c, 360), gamma));
    return result;
}

IntensityDistribution read_photometric_file(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (extension == ".ies") return read_ies(file);
    if (extension == ".ldt") return read_ldt(file);
    fail_input("{}: unknown kind of photometric file; allowed: .ies, .ldt", file.string());
}

}  // namespace etendue
