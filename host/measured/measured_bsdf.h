// Measured surfaces as shaders/surfaces/measured.glsl reads them, made from files.
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "host/spectra/spectral_value.h"

namespace etendue {

// Twin of struct MeasuredMap in shaders/lib/measured_maps.glsl, where the layout of the points is described.
struct MeasuredMap {
    uint32_t first = 0;  // of the points
    uint32_t width = 0, height = 0;
};

// Bits of MeasuredRef::kind; twins of those in shaders/surfaces/measured.glsl.
enum MeasuredKind : uint32_t {
    measured_halfway = 1,  // values stand over half vectors, warped as in an RGL file; else over directions
    measured_anisotropic = 2,  // turning the surface changes it
    measured_transmits = 4,    // slices for the far side follow those for the near one
    measured_symmetry = 4,     // shift of the number of parts of a turn that are alike
};

// Twin of struct MeasuredRef in shaders/surfaces/measured.glsl.
struct MeasuredRef {
    uint32_t kind = 0;
    uint32_t theta_first = 0, theta_count = 0;  // where the fixed directions are, among the points
    uint32_t phi_first = 0, phi_count = 0;
    uint32_t swept_first = 0, turn_first = 0;  // where the columns and rows of `density` are
    MeasuredMap density, visible, normals, area;
    uint32_t colors = 0, spectra = 0, channels = 0;
    glm::vec3 place_rgb{0};  // SpectrumRef: place of each wavelength among the channels
    uint32_t place_table = 0;
};
static_assert(sizeof(MeasuredRef) == 26 * 4);

struct MeasuredBsdf {
    MeasuredRef ref;                // places count from the beginning of the three lists
    std::vector<glm::vec2> points;  // of the maps, and lists of numbers (x)
    std::vector<float> colors;      // linear Rec.709 under D65, three a point of `density`
    std::vector<float> spectra;     // ref.channels a point; empty where the file holds colours
    SpectralValue place;  // of each wavelength among the channels: a spectrum that rises by one a channel
};

// An RGL file where the name ends in .bsdf, else a table in JSON (scenes/FORMAT.md, "Measured surfaces"). What is wrong
// in it fails with one line: the file, the place, what is allowed.
MeasuredBsdf read_measured_bsdf(const std::filesystem::path& path);
MeasuredBsdf read_rgl_file(const std::filesystem::path& path);
MeasuredBsdf read_bsdf_table(const std::filesystem::path& path);

// Adds the lists of one to those of another; gives its ref with the places there. The place of its spectrum
// is left to the caller.
MeasuredRef append(MeasuredBsdf& all, const MeasuredBsdf& one);

}  // namespace etendue
