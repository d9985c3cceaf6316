// Which rays a prescription takes from its fields, and what becomes of them at the image.
#pragma once
#include "host/lens/paraxial.h"
#include "host/lens/trace.h"

namespace etendue {

// The rays of a field through the entrance pupil: as large as the paraxial one of the primary wavelength, and
// shifted so that its middle is where the ray through the middle of the stop goes (a chief ray; of wide
// fields, pupils wander).
class FieldRays {
  public:
    // `figures`: of the primary wavelength.
    FieldRays(const Prescription& p, const ParaxialFigures& figures, const LensField& field);
    // Through the point `pupil` of the unit disk; starts on the plane of the first vertex, in its frame.
    LensRay ray(const glm::dvec2& pupil) const;

  private:
    void aim();

    const Prescription& p_;
    const ParaxialFigures& figures_;
    LensTracer tracer_;
    LensField field_;
    glm::dvec2 origin_{0};  // tangents of the angles, or, where the object is near, its point in mm
    glm::dvec2 middle_{0};  // mm, of the pupil
};

// Points of a square grid of `across` points within the unit disk.
std::vector<glm::dvec2> pupil_grid(size_t across);

struct LensSpot {
    glm::dvec2 chief{0};           // mm, on the image; not a number where the ray does not arrive
    glm::dvec2 centroid{0};        // mm
    double rms = 0, greatest = 0;  // mm from the centroid, weighted by the wavelengths
    double clear = 0;              // the part of the pupil whose rays arrive, at the primary wavelength
};

LensSpot lens_spot(const Prescription& p, const ParaxialFigures& figures, const LensField& field,
                   size_t across = 64);

// Gives surfaces without a semi-diameter that which the rays of the pupil need in all fields; they stop none.
void set_missing_semi_diameters(Prescription& p);

}  // namespace etendue
