// EULUMDAT files (.ldt; Stockmar 1990).
#pragma once
#include "host/photometry/ies_file.h"

namespace etendue {

// The plane C0 is across the length of the luminous opening. Of several sets of lamps the first one counts,
// with a warning.
IntensityDistribution read_ldt(const std::filesystem::path& file);

// Absolute photometry: one set, negative number of lamps, of the flux of the table. Without symmetry but the
// one about the axis. Values have nine digits.
std::string ldt_text(const IntensityDistribution& d, const PhotometricLabels& labels);
void write_ldt(const std::filesystem::path& file, const IntensityDistribution& d,
               const PhotometricLabels& labels);

}  // namespace etendue
