// OpenEXR files: every channel of an Image as 32-bit float, ZIP compressed. Pictures (R, G, B) carry the
// standard attributes chromaticities (Rec.709) and whiteLuminance (1 cd/m²).
#pragma once
#include <filesystem>

#include "host/image/image.h"

namespace etendue {

// Atomic: the file is whole, or what stood there before stays.
void write_exr(const std::filesystem::path& path, const Image& image);

// The data window of the first part, all channels, half and integer ones converted to float; text and number
// attributes. Fails with one line where the file is missing, damaged, deep, or has subsampled channels.
Image read_exr(const std::filesystem::path& path);

// The same for a file in memory; `name` begins every message.
Image read_exr(std::span<const std::byte> bytes, const std::string& name);

}  // namespace etendue
