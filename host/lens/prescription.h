// A lens as its prescription: surfaces in the order in which light meets them. Lengths in mm.
//
// Every surface has a frame whose z axis is the optical axis; the next one stands `thickness` further along
// z. After an odd number of mirrors light runs towards -z, and thicknesses are negative.
#pragma once
#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/lens/glass.h"
#include "host/lens/surface_shape.h"

namespace etendue {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Where a surface lets light through, in its xy plane.
struct LensAperture {
    double semi_diameter = infinite;  // mm, about `center`
    double inner_radius = 0;          // mm, about `center`: a hole of a mirror, an obstruction before a lens
    glm::dvec2 half_size{infinite};   // mm: of a rectangle
    glm::dvec2 center{0};
    // Stops rays. Else the size is only what the rays of a design need.
    bool is_stated = false;

    bool contains(const glm::dvec3& point) const;
    double extent() const;  // mm: the greatest distance from the axis
};

// Moves the frame in which the surfaces that follow stand: by `shift`, then its axes by `turn`, whose columns
// are the new axes in the old frame.
struct FrameChange {
    glm::dvec3 shift{0};
    glm::dmat3 turn{1};
};

// Ruled with equidistant grooves along x, as seen along z.
struct LensGrating {
    double lines_per_mm = 0;
    double order = 0;
};

struct LensSurface {
    SurfaceShape shape;
    double thickness = 0;  // mm
    Glass glass;           // behind it; of a mirror that before it
    bool is_mirror = false;
    LensAperture aperture;
    std::optional<FrameChange> frame_change;  // then it is nothing else
    std::optional<LensGrating> grating;
    std::string label;  // as the file numbers it; may be empty
};

struct LensField {
    glm::dvec2 value{0};  // as Prescription::field_kind says
    // Rays of the pupil's point p go through shift + (1 - compression) p, in parts of its radius.
    glm::dvec2 pupil_shift{0}, pupil_compression{0};
};

struct LensWavelength {
    double nm, weight;
};

struct Prescription {
    // What field values are: degrees from the axis in object space, or mm at the object or the image.
    enum class FieldKind { angle, object_height, paraxial_image_height, real_image_height };
    // What `pupil` is: the entrance pupil's diameter (mm); focal length by that diameter; half the inverse of
    // the axial beam's slope at the image; the sine of the axial beam at the object; or nothing, where the
    // stop's size decides.
    enum class PupilKind { entrance_diameter, f_number, working_f_number, object_aperture, stop_size };

    std::string file, title;
    double object_distance = infinite;  // mm, from the object to the first surface
    Glass object_glass;
    std::vector<LensSurface> surfaces;  // at least one and the image, which is the last
    size_t stop = 0;                    // index of a surface
    PupilKind pupil_kind = PupilKind::stop_size;
    double pupil = 0;
    FieldKind field_kind = FieldKind::angle;
    bool is_telecentric = false;              // chief rays leave the object along the axis
    std::vector<LensField> fields;            // at least one
    std::vector<LensWavelength> wavelengths;  // at least one
    size_t primary = 0;                       // of them
    std::vector<std::string> warnings;        // what was left out

    double primary_nm() const { return wavelengths[primary].nm; }
    // The medium before a surface.
    const Glass& glass_before(size_t surface) const {
        return surface == 0 ? object_glass : surfaces[surface - 1].glass;
    }
    // How messages name a surface: "FILE: surface 3".
    std::string name_of(size_t surface) const;
};

// Fails with one line where an aperture is larger than its sphere or conic, where surfaces cross within their
// apertures, or where the glass has no data at a wavelength. Apertures that the file does not fix end where
// glass does, with a warning.
void check_prescription(Prescription& p);

// Zemax (.zmx) and CODE V (.seq) files, and tables: whose rows hold radius (0 = plane), thickness behind,
// index or glass behind and diameter of a surface, then, if wanted, its conic constant and the coefficients
// of r⁴, r⁶, …, and the word "stop"; without it the first plane in air is the stop. Lines "title WORDS",
// "fields DEGREES …", "wavelengths NM …", "object DISTANCE", "# remark". Which it is the end of the name
// says. Errors: one line with file and line.
Prescription read_prescription(const std::filesystem::path& file);

}  // namespace etendue
