// Previews: 8-bit sRGB images for looking at, not for measuring.
#pragma once
#include <cstddef>
#include <filesystem>
#include <vector>

#include "host/image/image.h"

namespace etendue {

// The picture times 2^exposure, clipped to [0, 1] and encoded as sRGB (IEC 61966-2-1). Pixels that are not
// finite show as magenta.
std::vector<std::byte> encode_png(const Image& image, float exposure = 0.0f);
void write_png(const std::filesystem::path& path, const Image& image, float exposure = 0.0f);

}  // namespace etendue
