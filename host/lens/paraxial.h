// First-order figures of a prescription: rays near the axis. Tilts, decentres and gratings are left out.
#pragma once
#include "host/lens/prescription.h"

namespace etendue {

// Of a ray with height y and n u, index times slope: (y, n u) behind = ((a, b), (c, d)) (y, n u) before.
struct ParaxialMatrix {
    double a = 1, b = 0, c = 0, d = 1;
};

// All lengths in mm. Places in object space are from the vertex of the first surface, those in image space
// from that of the last before the image, along the axis of that frame.
struct ParaxialFigures {
    ParaxialMatrix matrix;                      // from the first vertex to the last
    double index_before = 1, index_behind = 1;  // negative behind an odd number of mirrors
    double focal_length;                        // 1 / power; infinite of an afocal lens
    double front_focus, rear_focus;             // the focal points; the latter is the back focal length
    double front_principal, rear_principal;     // the principal points
    double entrance_pupil, entrance_diameter;
    double exit_pupil, exit_diameter;
    double f_number;       // focal length by the entrance pupil's diameter
    double image;          // of the object, on the axis
    double magnification;  // of a finite object; else 0
};

ParaxialFigures paraxial_figures(const Prescription& p, double nm);

}  // namespace etendue
