#include "host/image/image.h"

#include <algorithm>
#include <stdexcept>

namespace etendue {

int find_channel(const Image& image, std::string_view name) {
    auto found = std::find(image.channels.begin(), image.channels.end(), name);
    return found == image.channels.end() ? -1 : int(found - image.channels.begin());
}

std::span<float> plane(Image& image, size_t channel) {
    return std::span(image.values).subspan(channel * pixel_count(image), pixel_count(image));
}

std::span<const float> plane(const Image& image, size_t channel) {
    return std::span(image.values).subspan(channel * pixel_count(image), pixel_count(image));
}

void add_channels(Image& image, const std::vector<std::string>& names, std::span<const float> pixels,
                  size_t stride) {
    size_t count = pixel_count(image);
    if (names.size() > stride || pixels.size() < count * stride)
        throw std::logic_error("add_channels: fewer floats than the image has pixels");
    image.values.reserve(image.values.size() + names.size() * count);
    for (size_t c = 0; c < names.size(); ++c) {
        image.channels.push_back(names[c]);
        for (size_t p = 0; p < count; ++p) image.values.push_back(pixels[p * stride + c]);
    }
}

void remove_channels(Image& image, std::string_view prefix) {
    Image kept{image.width, image.height, {}, {}, std::move(image.attributes)};
    for (size_t c = 0; c < image.channels.size(); ++c) {
        if (image.channels[c].starts_with(prefix)) continue;
        const auto values = plane(image, c);
        kept.channels.push_back(image.channels[c]);
        kept.values.insert(kept.values.end(), values.begin(), values.end());
    }
    image = std::move(kept);
}

std::array<size_t, 3> picture_channels(const Image& image) {
    int r = find_channel(image, "R"), g = find_channel(image, "G"), b = find_channel(image, "B");
    if (r >= 0 && g >= 0 && b >= 0) return {size_t(r), size_t(g), size_t(b)};
    size_t one = size_t(std::max(0, find_channel(image, "Y")));
    return {one, one, one};
}

}  // namespace etendue
