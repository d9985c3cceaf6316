// What a meter reads, over independent replicates of a render.
//
// The passes of a measurement are shared out to `replicates` renders that differ in their seeds alone: pass p
// is pass p / replicates of replicate p % replicates. Within a replicate samples are stratified over its
// passes, and so the spread of its passes says little; but replicates are independent, and the spread of
// their means tells the error of whatever is computed from them, without any assumption on how samples are
// made (randomized quasi-Monte Carlo; Owen 2013, "Monte Carlo theory, methods and examples", section 17.3).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/image/image.h"
#include "host/render/renderer.h"

namespace etendue {

constexpr uint32_t replicates = 16;

// Of a pixel's middle. Twin of the struct in shaders/kernels/measure_receivers.comp.
struct PixelPlace {
    glm::vec3 position;   // m, in the coordinates of the scene file
    glm::vec3 direction;  // unit, that light comes along at the middle; of an illuminance the meter's normal
    float extent;         // what the pixel stands for: m² of a meter in a plane, sr of one far away, else 0
};

struct Meter {
    std::string name, unit;  // "lx", "cd", "cd/m²"
    uint32_t columns = 0, rows = 0;
    bool is_far = false;      // its pixels are directions, by C and gamma (shaders/receivers/intensity.glsl)
    bool has_extent = false;  // values times extents make a flux, lm
    uint32_t triangles = 0;   // of a meter on the surface of a mesh, and of each of its parts
    std::vector<PixelPlace> places;
    size_t pixels() const { return size_t(columns) * rows; }
};
Meter describe_meter(Device& device, Scene& scene, const Receiver& receiver);

// Of the pixels of an intensity meter, degrees.
double c_angle(const Meter& meter, uint32_t column);
double gamma_angle(const Meter& meter, uint32_t row);

// Of a part of the light: a layer of the render (host/render/light_layers.h).
struct LayerReadings {
    std::string name;
    std::vector<ExactSum> sums;  // as Readings::sums
};

struct Readings {
    Meter meter;
    std::vector<ExactSum> sums;         // pixel after pixel, replicate after replicate
    std::vector<LayerReadings> layers;  // whose sum this is; none where nobody asks for them
    // Where paths carry wavelengths and bins are asked for, else 0; see render/spectral_film.h.
    uint32_t spectral_bins = 0;
    std::vector<ExactSum> spectra;      // pixel after pixel, of all replicates together
    CrossingSample rays;  // of a receiver that records them: unscaled
    std::vector<ExactSum> row_spectra;  // row after row, replicate after replicate: its pixels' sum
    uint64_t passes = 0;                // of each replicate
    uint64_t forward_paths = 0;         // that could have brought light in its passes
    uint64_t probing_paths = 0;  // … traced for no other end than to see whether any arrives, always the same
};

// A meter on a surface reads four things at each triangle, the `surface_parts`: readings of each alone, a row
// of pixels, a pixel a triangle; no spectra. Empty of other meters, and of such a part.
struct ReadingsPart {
    std::string name;
    Readings readings;
};
std::vector<ReadingsPart> parts_of(const Readings& readings);
bool has_parts(const Readings& readings);
// What a layer alone reads, without spectra.
Readings of_layer(const Readings& readings, const LayerReadings& layer);

using PixelMeans = std::vector<glm::dvec3>;  // linear Rec.709; (1, 1, 1) is one of the meter's units
PixelMeans replicate_means(const Readings& readings, uint32_t replicate);

// The spectrum of a row's mean pixel in a replicate, a value a bin.
std::vector<double> row_spectrum(const Readings& readings, uint32_t row, uint32_t replicate);

// The mean over all replicates as R, G, B, and its standard error as error.R, error.G, error.B, the same of
// layers with their names before; with bins the spectra, too.
Image to_image(const Readings& readings);

}  // namespace etendue
