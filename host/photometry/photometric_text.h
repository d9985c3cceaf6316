// What readers of photometric files share: lines with their intensities, and tables that symmetry completes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/photometry/intensity_distribution.h"
#include "host/text_lines.h"

namespace etendue {

constexpr size_t max_photometric_angles = 100'000;     // of planes and of angles in one
constexpr size_t max_photometric_values = 16'000'000;  // of a table

constexpr double max_candela = 1e15;

struct PhotometricText : TextLines {
    // An intensity where it is allowed; else it fails. `line` counts from 0.
    double candela(size_t line, double value, const std::string& what) const;
};

std::string read_photometric_bytes(const std::filesystem::path& file);
PhotometricText photometric_text(const std::string& file, std::string bytes);

// The lines of a table in their order, to be made a distribution.
struct PhotometricPlane {
    double longitude;             // degrees
    std::vector<double> candela;  // of each angle
};

// Completes a table by mirror images: `across_c0` about the plane C0-C180, `across_c90` about C90-C270.
// Sorts, and closes the circle.
void mirror_planes(std::vector<PhotometricPlane>& planes, bool across_c0, bool across_c90);

// Puts the table into `d`. Negative intensities become 0, with a warning.
void set_table(IntensityDistribution& d, const std::vector<PhotometricPlane>& planes);

// Warns where the flux of the table is more than 3 % off the one that the file states (lm; 0: it states
// none).
void compare_flux(IntensityDistribution& d, double stated, const char* what);

}  // namespace etendue
