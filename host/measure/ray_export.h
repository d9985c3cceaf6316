// What a receiver that records rays has recorded, as a ray file holds it.
#pragma once
#include <optional>

#include "host/measure/readings.h"
#include "host/photometry/ray_file.h"

namespace etendue {

// Rays that carry together what the meter has read: lumens with tristimulus values, or watts of one
// wavelength each. Nothing where none has been recorded.
std::optional<RayFile> recorded_rays(const Readings& readings);

}  // namespace etendue
