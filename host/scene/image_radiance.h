// Radiance pictures (.hdr, .pic): RGB mantissas with a shared exponent (Ward 1991, "Real Pixels", Graphics
// Gems II).
#pragma once
#include <span>
#include <string>

#include "host/scene/description.h"

namespace etendue {

bool is_radiance(std::span<const uint8_t> bytes);

// 32-bit_rle_rgbe with rows from the top, as all common programs write it. `where` begins every message.
ImageDescription decode_radiance(std::span<const uint8_t> bytes, const std::string& where,
                                 uint64_t max_texels);

}  // namespace etendue
