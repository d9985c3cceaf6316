// An image in memory: named float channels, rows from the top, with the attributes that travel with it.
//
// Channel names follow OpenEXR: the image itself is R, G, B; a layer's channels carry its name and a dot, as
// in albedo.R, normal.X, depth.Z, error.R, S1.R; those of spectral images are called S0.550,000000nm.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace etendue {

using Attribute = std::variant<std::string, double>;

struct Image {
    uint32_t width = 0, height = 0;
    std::vector<std::string> channels;
    std::vector<float> values;  // plane after plane in the order of `channels`, each width * height
    std::map<std::string, Attribute> attributes;
};

inline size_t pixel_count(const Image& image) { return size_t(image.width) * image.height; }

// Index of a channel in `channels`; -1 where there is none.
int find_channel(const Image& image, std::string_view name);
std::span<float> plane(Image& image, size_t channel);
std::span<const float> plane(const Image& image, size_t channel);

// Adds one channel a name, taken from pixels of `stride` floats each (4 for an array of vec4); what stands
// beyond the names in a pixel is left out.
void add_channels(Image& image, const std::vector<std::string>& names, std::span<const float> pixels,
                  size_t stride);

// Drops the channels whose name begins with `prefix`, such as a layer's "error.".
void remove_channels(Image& image, std::string_view prefix);

// The channels that show the picture: R, G, B where there are all three, else Y or the first channel three
// times.
std::array<size_t, 3> picture_channels(const Image& image);

}  // namespace etendue
