#include "host/image/png.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <cmath>
#include <new>

#include "host/image/atomic_file.h"

namespace etendue {
namespace {

uint8_t encode_srgb(float linear) {
    float x = std::fmin(std::fmax(linear, 0.0f), 1.0f);
    float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
    return uint8_t(std::lround(encoded * 255.0f));
}

void append_bytes(void* context, void* data, int size) {
    auto& bytes = *static_cast<std::vector<std::byte>*>(context);
    auto* first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}

}  // namespace

std::vector<std::byte> encode_png(const Image& image, float exposure) {
    auto channels = picture_channels(image);
    float scale = std::exp2(exposure);
    std::vector<uint8_t> pixels(pixel_count(image) * 3);
    for (size_t p = 0; p < pixel_count(image); ++p) {
        bool finite = true;
        for (size_t c = 0; c < 3; ++c) {
            float value = plane(image, channels[c])[p];
            finite = finite && std::isfinite(value);
            pixels[3 * p + c] = encode_srgb(value * scale);
        }
        if (!finite) pixels[3 * p] = 255, pixels[3 * p + 1] = 0, pixels[3 * p + 2] = 255;
    }
    std::vector<std::byte> bytes;
    if (!stbi_write_png_to_func(append_bytes, &bytes, int(image.width), int(image.height), 3, pixels.data(),
                                int(image.width) * 3))
        throw std::bad_alloc();
    return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image, float exposure) {
    write_atomically(path, encode_png(image, exposure));
}

}  // namespace etendue
