// A lens drawn: its section through the yz plane of its first surface, with rays.
#pragma once
#include <string>

#include "host/lens/pupil_rays.h"

namespace etendue {

// An SVG image. From each field `rays` rays of the primary wavelength, spread over the pupil's height; they
// end where an aperture stops them.
std::string lens_drawing(const Prescription& p, const ParaxialFigures& figures, size_t rays);

}  // namespace etendue
