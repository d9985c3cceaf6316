// What readers of photometric files share: lines with their numbers, and tables that symmetry completes.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/error.h"
#include "host/photometry/intensity_distribution.h"

namespace etendue {

constexpr size_t max_photometric_angles = 100'000;     // of planes and of angles in one
constexpr size_t max_photometric_values = 16'000'000;  // of a table

constexpr double max_candela = 1e15;

struct PhotometricText {
    std::string file;
    std::vector<std::string> lines;  // without line ends and what is blank around

    // `line` counts from 0.
    template <class... Args>
    [[noreturn]] void fail(size_t line, fmt::format_string<Args...> format, Args&&... args) const {
        fail_input("{}: line {}: {}", file, line + 1, fmt::format(format, std::forward<Args>(args)...));
    }
    // What stands in that line for `what`, where it is allowed; else they fail.
    double number(size_t line, std::string_view word, const std::string& what) const;
    double candela(size_t line, double value, const std::string& what) const;
    size_t count(size_t line, double value, const std::string& what, size_t least, size_t most) const;
};

std::string read_photometric_bytes(const std::filesystem::path& file);
PhotometricText photometric_text(const std::string& file, std::string bytes);

std::string_view trimmed(std::string_view text);

// A finite number of at most 1e15, all of `text`. False where it is none.
bool parse_number(std::string_view text, double& value);

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
