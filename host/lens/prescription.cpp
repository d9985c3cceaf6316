#include "host/lens/prescription.h"

#include <algorithm>

#include "host/error.h"

namespace etendue {
namespace {

// Where surfaces i and j, `distance` apart along z, cross nearest to the axis; none where they do not, within
// their common aperture.
std::optional<double> crossing(const LensSurface& a, const LensSurface& b, double distance) {
    const double radius =
        std::min({a.aperture.extent(), b.aperture.extent(), a.shape.reach(), b.shape.reach()});
    if (!std::isfinite(radius)) return {};
    constexpr int steps = 256;
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

void check_crossings(const Prescription& p) {
    std::optional<size_t> last;  // that does something, on the same axis
    double distance = 0, towards = 1;
    for (size_t i = 0; i + 1 < p.surfaces.size(); ++i) {
        const LensSurface& s = p.surfaces[i];
        if (s.frame_change || s.aperture.center != glm::dvec2(0)) {
            last = {};
        } else if (is_active(p, i)) {
            if (last && distance * towards > 0)
                if (const auto y = crossing(p.surfaces[*last], s, distance))
                    fail_input(
                        "{}: surfaces {} and {} cross {:.5g} mm from the axis, within their apertures; there "
                        "must be "
                        "room between them",
                        p.file, p.surfaces[*last].label, s.label, *y);
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

void check_prescription(const Prescription& p) {
    for (size_t i = 0; i + 1 < p.surfaces.size(); ++i) {
        const LensSurface& s = p.surfaces[i];
        const double reach = s.shape.reach(),
                     extent = s.shape.is_cylinder ? s.aperture.center.y + std::min(s.aperture.half_size.y,
                                                                                   s.aperture.semi_diameter)
                                                  : s.aperture.extent();
        if (std::isfinite(extent) && extent > reach * (1 + 1e-6))
            fail_input(
                "{}: the aperture reaches {:.6g} mm from the axis; a surface of radius {:.6g} mm{} has at "
                "most {:.6g}",
                p.name_of(i), extent, 1 / s.shape.curvature,
                s.shape.conic == 0 ? "" : fmt::format(" and conic constant {:.6g}", s.shape.conic), reach);
        for (const LensWavelength& w : p.wavelengths) {
            const double index = s.glass.index(w.nm);
            if (!s.glass.covers(w.nm) || !(index >= 0.1 && index <= 10))
                fail_input("{}: {} has no index at {:.6g} nm", p.name_of(i), s.glass.name(), w.nm);
        }
    }
    check_crossings(p);
}

}  // namespace etendue
