// Luminous intensity of a lamp over directions, as makers measure and publish it: what photometric files
// hold, whatever their kind.
//
// The photometric frame of a lamp: gamma = 0 along -z, the plane C0 towards +x, C90 towards +y.
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace etendue {

// The luminous surface. Round ones have diameters for sizes.
struct LuminousOpening {
    enum class Kind { point, rectangle, box, disk, ellipse, cylinder, sphere };
    Kind kind = Kind::point;
    glm::dvec3 size{0};  // m, along C0, along C90, upwards
    int axis = 2;        // 0 to 2, as in `size`: along a cylinder, across what is flat

    bool operator==(const LuminousOpening&) const = default;
};

// "rectangle 0.6 x 0.3 m".
std::string opening_text(const LuminousOpening& opening);

// A table over longitude (`planes`) and angle from a pole (`angles`); where the pole lies is what the three
// types of tables differ in, so none is resampled:
//   c  pole at gamma = 0, -z; longitudes are C
//   b  pole towards C90, +y; longitudes are V, from -z towards +x, and 90 - angle is H
//   a  pole towards C0, +x; longitudes are H, from -z towards +y, and 90 - angle is V
// Bilinear in both. Dark beyond the first and the last angle or plane, but a table around the whole circle is
// closed: its last plane is the first plus 360. One plane stands for all.
struct IntensityDistribution {
    enum class Type { c, b, a };
    Type type = Type::c;
    std::vector<double> planes;   // degrees, rising
    std::vector<double> angles;   // degrees, rising, at least two, within [0, 180]
    std::vector<double> candela;  // of each plane, of each angle in it; all factors applied
    LuminousOpening opening;
    double watts = 0;
    std::vector<std::string> description;  // lines, as the file has them
    std::vector<std::string> warnings;     // what was corrected, and what does not fit

    double at(size_t plane, size_t angle) const { return candela[plane * angles.size() + angle]; }
    double intensity(double c, double gamma) const;       // cd; degrees
    double intensity(const glm::dvec3& direction) const;  // cd; unit, away from the lamp, in its frame
    double flux() const;                                  // lm, of the bilinear table, exactly
    double ring_flux(size_t angle) const;                 // … from one angle to the next
    double peak() const;                                  // cd
};

// The same light as a table of type c with planes and angles 1 degree apart, where it is of another type.
IntensityDistribution in_c_planes(const IntensityDistribution& d);

// By the file's extension, .ies or .ldt, in letters of any case. Errors: one line with file, line and reason.
IntensityDistribution read_photometric_file(const std::filesystem::path& file);

}  // namespace etendue
