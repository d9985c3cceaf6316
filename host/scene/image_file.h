// Image files that scenes use: PNG, JPEG and WebP (8 bits a channel), Radiance .hdr and OpenEXR (linear
// floats).
#pragma once
#include <filesystem>
#include <span>

#include "host/scene/description.h"

namespace etendue {

// The kind of image is told from the first bytes. Rows from the top. `where` begins every message ("FILE" or
// "FILE: /json/pointer"). A floating-point image with a texel that is not finite is refused.
ImageDescription decode_image(std::span<const uint8_t> bytes, const std::string& where);
ImageDescription read_image_file(const std::filesystem::path& file);

}  // namespace etendue
