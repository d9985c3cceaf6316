// Photometric files of IES LM-63, of 1986, 1991, 1995, 2002 and 2019 (.ies).
#pragma once
#include <optional>
#include <string>

#include "host/photometry/intensity_distribution.h"

namespace etendue {

// What a written file says of the lamp; may be empty.
struct PhotometricLabels {
    std::string manufacturer, luminaire, number, laboratory, date;
};

// Types C, B and A. The plane C0 is along the length of the luminous opening (LM-63-1995), the width across
// it. Of the factors of TILT=INCLUDE, for luminaires that are tilted, the first one counts, and a warning
// tells them.
IntensityDistribution read_ies(const std::filesystem::path& file);
// `name` is for messages; `folder`: where a file that TILT names is looked for.
IntensityDistribution parse_ies(const std::string& name, std::string bytes,
                                const std::optional<std::filesystem::path>& folder = {});

// LM-63-2019, type C, absolute, made by simulation (file generation type 1.00010); another type is resampled
// (in_c_planes). Values have nine digits.
std::string ies_text(const IntensityDistribution& d, const PhotometricLabels& labels);
void write_ies(const std::filesystem::path& file, const IntensityDistribution& d,
               const PhotometricLabels& labels);

}  // namespace etendue
