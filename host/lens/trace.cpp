#include "host/lens/trace.h"

#include <algorithm>

namespace etendue {
namespace {

// The part of the wave vector along a surface goes on, in units of 2π/λ: of length `index` before and
// `index_behind` behind. The grating adds order × wavelength × lines. False where there is no such ray.
bool bend(glm::dvec3& direction, const glm::dvec3& normal, double index, double index_behind, bool mirror,
          const glm::dvec3& grating_vector) {
    const double along = glm::dot(direction, normal);
    const glm::dvec3 tangential =
        index * (direction - along * normal) + grating_vector - glm::dot(grating_vector, normal) * normal;
    const double squared = index_behind * index_behind - glm::dot(tangential, tangential);
    if (squared < 0) return false;
    const double side = (along < 0) != mirror ? -1 : 1;
    direction = glm::normalize(tangential + side * std::sqrt(squared) * normal);
    return true;
}

}  // namespace

LensTracer::LensTracer(const Prescription& p, double nm) : p_(p), nm_(nm) {
    for (size_t i = 0; i <= p.surfaces.size(); ++i) indices_.push_back(p.glass_before(i).index(nm));
}

LensRay in_next_frame(const Prescription& p, size_t surface, LensRay ray) {
    if (surface > 0) ray.position.z -= p.surfaces[surface - 1].thickness;
    if (const auto& change = p.surfaces[surface].frame_change) {
        ray.position = (ray.position - change->shift) * change->turn;  // by the transpose
        ray.direction = ray.direction * change->turn;
    }
    return ray;
}

TracedRay LensTracer::trace(const LensRay& start) const {
    TracedRay traced;
    traced.points.reserve(p_.surfaces.size());
    LensRay ray = start;
    for (size_t i = 0; i < p_.surfaces.size(); ++i) {
        const LensSurface& s = p_.surfaces[i];
        ray = in_next_frame(p_, i, ray);
        if (!s.frame_change) {
            const auto t = s.shape.intersect(ray.position, ray.direction);
            if (!t) {
                traced.fate = TracedRay::Fate::misses;
                return traced;
            }
            ray.position += *t * ray.direction;
            if (!traced.stopped && !s.aperture.contains(ray.position)) traced.stopped = i;
            const double before = indices_[i], behind = s.is_mirror ? before : indices_[i + 1];
            if (s.is_mirror || s.grating || before != behind) {
                glm::dvec3 grating(0);
                if (s.grating) grating.y = s.grating->order * s.grating->lines_per_mm * nm_ * 1e-6;
                if (!bend(ray.direction, s.shape.normal(ray.position), before, behind, s.is_mirror,
                          grating)) {
                    traced.fate =
                        s.grating ? TracedRay::Fate::evanescent : TracedRay::Fate::totally_reflected;
                    return traced;
                }
            }
        }
        traced.points.push_back(ray);
    }
    return traced;
}

std::vector<FrameChange> lens_frames(const Prescription& p) {
    std::vector<FrameChange> frames;
    FrameChange frame;
    for (size_t i = 0; i < p.surfaces.size(); ++i) {
        if (i > 0) frame.shift += frame.turn * glm::dvec3(0, 0, p.surfaces[i - 1].thickness);
        if (const auto& change = p.surfaces[i].frame_change) {
            frame.shift += frame.turn * change->shift;
            frame.turn = frame.turn * change->turn;
        }
        frames.push_back(frame);
    }
    return frames;
}

}  // namespace etendue
