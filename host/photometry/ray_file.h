// Ray files: a source of light as single rays, as makers publish it and as other programs trace it.
//
// Positions and directions are in the frame of the file, which the class `rays` takes for that of its node.
#pragma once
#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace etendue {

struct SourceRay {
    glm::vec3 position;   // mm
    glm::vec3 direction;  // unit, the way light travels
    float flux;           // W or lm, as RayFile says

    bool operator==(const SourceRay&) const = default;
};

// Linear between its points, dark beyond them; of any scale.
struct RaySpectrum {
    std::vector<float> nm, weights;  // as many of both, at least one; nm rises

    bool operator==(const RaySpectrum&) const = default;
};

// S1 to S3 as parts of the flux, at most 1 together, and the direction of their x axis, which counts as far
// as it lies across that of the ray, as TM-25 has them; signs are those of shaders/lib/stokes.glsl.
struct RayPolarization {
    glm::vec3 stokes, axis;

    bool operator==(const RayPolarization&) const = default;
};

// What such a file holds. Rays have spectra by `wavelengths`, or by `spectra`, or none.
struct RayFile {
    enum class Unit { watt, lumen };
    Unit unit = Unit::watt;              // of SourceRay::flux
    std::vector<SourceRay> rays;         // at least one, not all of them dark
    std::vector<float> lumens;           // of each ray, beside its watts; empty = not told
    std::vector<glm::vec2> tristimulus;  // X and Z of each ray, beside its lumens, which are Y; or empty
    std::vector<float> wavelengths;      // nm, of each ray
    std::vector<RaySpectrum> spectra;    // tables
    std::vector<uint32_t> spectrum_of;   // of each ray, an index into `spectra`; empty = all have the first
    std::vector<RayPolarization> polarization;   // of each ray, or empty
    double stated_watts = 0, stated_lumens = 0;  // of all rays, beside them; 0 = not told
    std::string format;                          // "TM-25"
    std::array<std::string, 9> texts;   // of TM-25's header: name, manufacturer, creator of the model, …
    std::vector<std::string> warnings;  // what was corrected, and what does not fit

    double flux() const;  // sum over the rays, in `unit`
};

constexpr uint64_t most_rays = 100'000'000;
constexpr float farthest_ray = 1e9f;  // mm, of a start from the origin, along each axis

// TM-25 (.tm25ray), Zemax (.dat, .sdf; binary or text), LightTools and Speos (.ray); which of them is told by
// what is in the file. It is streamed: memory is that of what it holds, 28 to 40 bytes a ray. Errors: one
// line with file, byte or ray, what is wrong and what is allowed.
RayFile read_ray_file(const std::filesystem::path& file);

// TM-25 of 2013: positions, directions, watts or lumens or both, and where there are watts wavelengths (kind
// 2) or tables (kinds 3, 4), where there are lumens alone tristimulus values. What is written reads back to
// the same. `date` as ISO 8601 has it, at most 27 characters.
void write_tm25(const std::filesystem::path& file, const RayFile& rays, const std::string& date = "");

}  // namespace etendue
