#include "host/lens/prescription.h"

#include <algorithm>

#include "host/error.h"

namespace etendue {
namespace {

// How far from the axis surfaces `distance` apart along z first cross, within their common aperture.
std::optional<double> crossing(const LensSurface& a, const LensSurface& b, double distance) {
    const double extent = std::min(a.aperture.extent(), b.aperture.extent());
    if (!std::isfinite(extent)) return {};
    const double radius = std::min({extent, a.shape.reach(), b.shape.reach()});
    constexpr int steps = 1024;
    for (int i = 0; i <= steps; ++i) {
        const double y = radius * i / steps, gap = distance + b.shape.sag(0, y) - a.shape.sag(0, y);
        if (gap * distance < 0 && std::abs(gap) > 1e-9 * (1 + std::abs(distance))) return y;
    }
    return {};
}

bool is_active(const Prescription& p, size_t i) {
    const LensSurface& s = p.surfaces[i];
    return s.is_mirror || !(s.glass == p.glass_before(i));
}

// Ends an aperture there. Only where the file does not fix its size.
void end_aperture(Prescription& p, size_t i, double radius) {
    p.warnings.push_back(fmt::format("surface {}: ends {:.5g} mm from the axis, where its glass does",
                                     p.surfaces[i].label, radius));
    p.surfaces[i].aperture.semi_diameter = radius, p.surfaces[i].aperture.is_stated = true;
}

void check_crossing(Prescription& p, size_t a, size_t b, double distance) {
    const auto radius = crossing(p.surfaces[a], p.surfaces[b], distance);
    if (!radius) return;
    const bool is_fixed = p.surfaces[a].aperture.is_stated && p.surfaces[b].aperture.is_stated;
    if (is_fixed || *radius < 1e-3 * std::abs(distance))
        fail_input(
            "{}: surfaces {} and {} cross {:.5g} mm from the axis, within their apertures; there must be "
            "room between them",
            p.file, p.surfaces[a].label, p.surfaces[b].label, *radius);
    const double inside = *radius * (1 - 1.0 / 512);  // a step of the search
    for (const size_t i : {a, b})
        if (!p.surfaces[i].aperture.is_stated && p.surfaces[i].aperture.extent() > inside)
            end_aperture(p, i, inside);
}

void check_crossings(Prescription& p) {
    std::optional<size_t> last;  // that does something, on the same axis
    double distance = 0, towards = 1;
    for (size_t i = 0; i + 1 < p.surfaces.size(); ++i) {
        const LensSurface& s = p.surfaces[i];
        if (s.frame_change || s.aperture.center != glm::dvec2(0)) {
            last = {};
        } else if (is_active(p, i)) {
            if (last && distance * towards > 0) check_crossing(p, *last, i, distance);
            last = i, distance = 0;
            if (s.is_mirror) towards = -towards;
        }
        distance += s.thickness;
    }
}

}  // namespace

bool LensAperture::contains(const glm::dvec3& point) const {
    if (!is_stated) return true;
    const glm::dvec2 p = glm::abs(glm::dvec2(point) - center);
    const double r = glm::length(p), slack = 1 + 1e-9;
    return r <= semi_diameter * slack && r >= inner_radius && p.x <= half_size.x * slack &&
           p.y <= half_size.y * slack;
}

double LensAperture::extent() const {
    return glm::length(center) + std::min(semi_diameter, glm::length(half_size));
}

std::string Prescription::name_of(size_t surface) const {
    return fmt::format("{}: surface {}", file, surfaces[surface].label);
}

void check_prescription(Prescription& p) {
    for (size_t i = 0; i + 1 < p.surfaces.size(); ++i) {
        const LensSurface& s = p.surfaces[i];
        const LensAperture& a = s.aperture;
        const double reach = s.shape.reach();
        const double extent = s.shape.is_cylinder
                                  ? std::abs(a.center.y) + std::min(a.half_size.y, a.semi_diameter)
                                  : a.extent();
        if (std::isfinite(extent) && extent > reach * (1 + 1e-6)) {
            if (a.is_stated)
                fail_input(
                    "{}: its aperture reaches {:.6g} mm from the axis; {} of radius {:.6g} mm has at most "
                    "{:.6g}",
                    p.name_of(i), extent,
                    s.shape.conic == 0 ? "a sphere"
                                       : fmt::format("a conic of constant {:.6g}", s.shape.conic),
                    1 / s.shape.curvature, reach);
            end_aperture(p, i, reach);
        }
        for (const LensWavelength& w : p.wavelengths) {
            const double index = s.glass.index(w.nm);
            if (!s.glass.covers(w.nm) || !(index >= 0.1 && index <= 10))
                fail_input("{}: {} has no index at {:.6g} nm", p.name_of(i), s.glass.name(), w.nm);
        }
    }
    check_crossings(p);
}

}  // namespace etendue
