#include "host/lens/pupil_rays.h"

#include <algorithm>
#include <numbers>

namespace etendue {
namespace {

using FieldKind = Prescription::FieldKind;
constexpr double degree = std::numbers::pi / 180;

}  // namespace

FieldRays::FieldRays(const Prescription& p, const ParaxialFigures& figures, const LensField& field)
    : p_(p), figures_(figures), tracer_(p, p.primary_nm()), field_(field) {
    const bool is_far = std::isinf(p.object_distance);
    glm::dvec2 origin = field.value;
    if (p.field_kind == FieldKind::angle)
        origin =
            glm::tan(degree * field.value) * (is_far ? 1 : -(p.object_distance + figures.entrance_pupil));
    const double scale = is_far ? 1 / figures.focal_length : 1 / figures.magnification;
    const bool is_image =
        p.field_kind == FieldKind::paraxial_image_height || p.field_kind == FieldKind::real_image_height;
    if (is_image) origin *= scale;
    constexpr int steps = 8;  // outwards, since the first aim must come through
    for (int i = 1; i <= steps; ++i) origin_ = origin * (double(i) / steps), aim();
    if (p.field_kind != FieldKind::real_image_height) return;
    // Until the chief ray comes to the height: the paraxial scale corrects what is missing.
    for (int turn = 0; turn < 50; ++turn) {
        const TracedRay chief = tracer_.trace(ray({0, 0}));
        if (chief.fate != TracedRay::Fate::arrives) return;
        const glm::dvec2 missing = field.value - glm::dvec2(chief.at_image().position);
        origin_ += scale * missing, aim();
        if (glm::length(missing) < 1e-12 * (1 + glm::length(field.value))) return;
    }
}

// Newton's method on each axis, by differences; stays where it is if rays do not come to the stop.
void FieldRays::aim() {
    if (p_.is_telecentric || origin_ == glm::dvec2(0)) return;
    const glm::dvec2 shift = field_.pupil_shift;
    field_.pupil_shift = {0, 0};
    const double step = 1e-4 * figures_.entrance_diameter;
    const auto at_stop = [&](const glm::dvec2& middle) -> std::optional<glm::dvec2> {
        middle_ = middle;
        const TracedRay traced = tracer_.trace(ray({0, 0}));
        if (traced.points.size() <= p_.stop) return {};
        return glm::dvec2(traced.points[p_.stop].position);
    };
    glm::dvec2 middle = middle_;
    for (int turn = 0; turn < 30; ++turn) {
        const auto here = at_stop(middle), there = at_stop(middle + step);
        if (!here || !there) break;
        const glm::dvec2 move = *here * step / (*there - *here);
        if (!(glm::length(move) < figures_.entrance_diameter)) break;
        middle -= move;
        if (glm::length(move) < 1e-13 * figures_.entrance_diameter) break;
    }
    middle_ = middle, field_.pupil_shift = shift;
}

LensRay FieldRays::ray(const glm::dvec2& pupil) const {
    const glm::dvec2 at = middle_ + 0.5 * figures_.entrance_diameter *
                                        (field_.pupil_shift + (1.0 - field_.pupil_compression) * pupil);
    const double z = figures_.entrance_pupil;
    if (std::isinf(p_.object_distance))
        return {{at - z * origin_, 0}, glm::normalize(glm::dvec3(origin_, 1))};
    const glm::dvec2 slope = (at - origin_) / (p_.object_distance + z);
    return {{origin_ + p_.object_distance * slope, 0}, glm::normalize(glm::dvec3(slope, 1))};
}

std::vector<glm::dvec2> pupil_grid(size_t across) {
    std::vector<glm::dvec2> points;
    for (size_t j = 0; j < across; ++j)
        for (size_t i = 0; i < across; ++i) {
            const glm::dvec2 p = (glm::dvec2(i, j) + 0.5) * (2.0 / double(across)) - 1.0;
            if (glm::dot(p, p) <= 1) points.push_back(p);
        }
    return points;
}

LensSpot lens_spot(const Prescription& p, const ParaxialFigures& figures, const LensField& field,
                   size_t across) {
    const FieldRays rays(p, figures, field);
    LensSpot spot;
    const std::vector<glm::dvec2> grid = pupil_grid(across);
    std::vector<glm::dvec3> hits;  // and weight
    double weight = 0;
    for (size_t w = 0; w < p.wavelengths.size(); ++w) {
        const LensTracer tracer(p, p.wavelengths[w].nm);
        size_t arrived = 0;
        for (const glm::dvec2& point : grid) {
            const TracedRay traced = tracer.trace(rays.ray(point));
            if (!traced.passes()) continue;
            ++arrived;
            hits.emplace_back(glm::dvec2(traced.at_image().position), p.wavelengths[w].weight);
            spot.centroid += hits.back().z * glm::dvec2(hits.back());
            weight += hits.back().z;
        }
        if (w != p.primary) continue;
        spot.clear = double(arrived) / double(grid.size());
        const TracedRay chief = tracer.trace(rays.ray({0, 0}));
        spot.chief =
            chief.fate == TracedRay::Fate::arrives ? glm::dvec2(chief.at_image().position) : glm::dvec2(NAN);
    }
    spot.centroid /= weight;
    for (const glm::dvec3& hit : hits) {
        const double r = glm::distance(glm::dvec2(hit), spot.centroid);
        spot.rms += hit.z * r * r / weight;
        spot.greatest = std::max(spot.greatest, r);
    }
    spot.rms = std::sqrt(spot.rms);
    return spot;
}

void set_missing_semi_diameters(Prescription& p) {
    const ParaxialFigures figures = paraxial_figures(p, p.primary_nm());
    std::vector<double> needed(p.surfaces.size(), 0);
    for (const LensWavelength& w : p.wavelengths) {
        const LensTracer tracer(p, w.nm);
        for (const LensField& field : p.fields) {
            const FieldRays rays(p, figures, field);
            // Zones of equal area: near a focus the inner ones may need more than the edge.
            for (int i = 0; i < 128; ++i) {
                const double turn = 2 * std::numbers::pi * (i / 4) / 32, r = std::sqrt((4 - i % 4) / 4.0);
                const TracedRay traced = tracer.trace(rays.ray({r * std::cos(turn), r * std::sin(turn)}));
                for (size_t s = 0; s < traced.points.size(); ++s)
                    needed[s] = std::max(needed[s], glm::length(glm::dvec2(traced.points[s].position)));
            }
        }
    }
    for (size_t s = 0; s < p.surfaces.size(); ++s)
        if (LensAperture& a = p.surfaces[s].aperture;
            std::isinf(a.extent()) && needed[s] > 0 && !p.surfaces[s].frame_change)
            a.semi_diameter = needed[s];
}

}  // namespace etendue
