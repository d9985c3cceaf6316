// Glare, as an observer has it who looks along the axis of a luminance meter of half the sphere.
#pragma once
#include <vector>

#include "host/measure/figures.h"

namespace etendue {

// How much less a glare source disturbs than one on the line of sight, at least 1. `direction` and `sight`:
// unit, from the eye; `up`: unit, at right angles to the line of sight. Above it Guth's index as Levin's
// equation has it (Levin 1975, "Position Index in VCP Calculations", Journal of the IES 4(2)), which CIE
// 117:1995 tabulates; below it Iwata & Tokura 1997, "Position Index for a Glare Source Located Below the Line
// of Vision". Never more than 16, where the table ends.
double position_index(const glm::dvec3& direction, const glm::dvec3& sight, const glm::dvec3& up);

// A luminance meter has these figures if its pixels are many and cover the half space before it: the
// illuminance at the eye, lx; the luminance of the background, cd/m², that illuminance without the glare
// sources over pi; and the unified glare rating UGR = 8 lg(0.25 / background · sum of L² ω / p²) (CIE
// 117:1995, equation 1). A glare source is what is brighter than `glare_from`, cd/m², in the mean over all
// passes. +y of the scene is up.
std::vector<Figure> glare_figures(const Meter& meter, const std::vector<std::vector<double>>& values,
                                  double glare_from);

}  // namespace etendue
