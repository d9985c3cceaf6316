// Real rays through a prescription, surface after surface, in double precision.
#pragma once
#include "host/lens/prescription.h"

namespace etendue {

struct LensRay {
    glm::dvec3 position;   // mm
    glm::dvec3 direction;  // unit
};

struct TracedRay {
    enum class Fate { arrives, misses, totally_reflected, evanescent };
    // Where it meets each surface and its direction behind it, in the frame of that surface; of a change of
    // frame the ray in the new one. As far as it comes.
    std::vector<LensRay> points;
    Fate fate = Fate::arrives;      // else at the surface behind the last point
    std::optional<size_t> stopped;  // the first surface whose aperture stops it; it is traced on nevertheless

    bool passes() const { return fate == Fate::arrives && !stopped; }
    const LensRay& at_image() const { return points.back(); }
};

// Traces rays of one wavelength; a prescription must outlive its tracer.
class LensTracer {
  public:
    LensTracer(const Prescription& p, double nm);
    // `start` in the frame of the first surface. Rays go from surface to surface even where that is backward.
    TracedRay trace(const LensRay& start) const;

  private:
    const Prescription& p_;
    double nm_;
    std::vector<double> indices_;  // of what is before each surface, and behind the last
};

// From the frame of the surface before it to that of a surface; the first has the frame of the prescription.
LensRay in_next_frame(const Prescription& p, size_t surface, LensRay ray);
// The frames of all surfaces in that of the first: origin and axes.
std::vector<FrameChange> lens_frames(const Prescription& p);

}  // namespace etendue
