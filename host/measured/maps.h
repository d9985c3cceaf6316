// Parts of a MeasuredBsdf that both kinds of files are made of.
#pragma once
#include <span>
#include <utility>

#include "host/measured/measured_bsdf.h"

namespace etendue {

constexpr size_t most_map_points = 1024;  // along an axis; lib/measured_maps.glsl searches no further

// A list of numbers; gives its place among the points.
uint32_t add_numbers(MeasuredBsdf& bsdf, std::span<const double> numbers);

// Functions on a grid of columns and rows at rising coordinates, one a slice: values[slice][row][column], at
// least 0. With `normalize` each slice is scaled to integrate to one; an empty one becomes constant.
MeasuredMap add_map(MeasuredBsdf& bsdf, std::span<const float> values, std::span<const double> columns,
                    std::span<const double> rows, bool normalize);

// Colours and spectra from values[point][channel], at least 0. No wavelengths: the three channels are linear
// Rec.709. Else there is one for each wavelength, in nm, rising; outside them the ends hold.
void add_channels(MeasuredBsdf& bsdf, std::span<const float> values, std::span<const double> wavelengths);

// Channels [first, second) of those at rising wavelengths, nm: what paths carry lies between them.
std::pair<size_t, size_t> visible_channels(std::span<const double> wavelengths);
// Where a wavelength stands on such a list, as a fraction of the way from one to the next.
SpectralTable channel_places(std::span<const double> wavelengths);

// `count` coordinates, evenly over [0, 1].
std::vector<double> even_coordinates(size_t count);

}  // namespace etendue
