#include "host/scene/image_file.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <webp/decode.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/scene/image_radiance.h"

namespace etendue {
namespace {

// 16384 x 16384: a header that asks for more is taken for damaged.
const uint64_t max_texels = uint64_t(1) << 28;

// stb_image reads zeros past the end of its input, and a truncated image comes out whole but black in part.
// Here the source notes that more was asked for than there is.
struct Source {
    std::span<const uint8_t> bytes;
    size_t at = 0;
    bool ran_out = false;
};

int read_source(void* user, char* data, int size) {
    auto& source = *static_cast<Source*>(user);
    size_t count = std::min(size_t(size), source.bytes.size() - source.at);
    std::copy_n(source.bytes.data() + source.at, count, data);
    source.at += count;
    source.ran_out = source.ran_out || count == 0;
    return int(count);
}

void skip_source(void* user, int size) {
    auto& source = *static_cast<Source*>(user);
    int64_t at = int64_t(source.at) + size;
    source.ran_out = source.ran_out || at > int64_t(source.bytes.size());
    source.at = size_t(std::clamp<int64_t>(at, 0, int64_t(source.bytes.size())));
}

int source_ended(void* user) {
    auto& source = *static_cast<Source*>(user);
    return source.at >= source.bytes.size();
}

const stbi_io_callbacks source_callbacks = {read_source, skip_source, source_ended};

// stb_image before 2.28 writes past its tables where a JPEG announces more than 256 Huffman codes in one of
// them (ITU-T T.81, B.2.4.2: the 16 counts of codes by length). Walks the segments; what lies between is
// coded data.
void check_jpeg_tables(std::span<const uint8_t> bytes, const std::string& where) {
    for (size_t at = 2; at + 4 <= bytes.size();) {
        const uint8_t marker = bytes[at + 1];
        const bool is_segment =
            bytes[at] == 0xFF && marker >= 0xC0 && marker != 0xFF && (marker < 0xD0 || marker > 0xD9);
        if (!is_segment) {
            ++at;
            continue;
        }
        const size_t end = std::min(bytes.size(), at + 2 + (size_t(bytes[at + 2]) << 8 | bytes[at + 3]));
        for (size_t table = at + 4; marker == 0xC4 && table < end && table + 17 <= bytes.size();) {
            const size_t codes = std::accumulate(&bytes[table + 1], &bytes[table + 1] + 16, size_t(0));
            if (codes > 256)
                fail_input("{}: the image is damaged: a Huffman table of {} codes", where, codes);
            table += 17 + codes;
        }
        at = std::max(end, at + 4);
    }
}

struct StbiFree {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

void check_size(uint64_t width, uint64_t height, const std::string& where) {
    if (width == 0 || height == 0 || width * height > max_texels)
        fail_input("{}: the image has {} x {} texels; 1 to {} are allowed", where, width, height, max_texels);
}

void check_finite(const ImageDescription& image, const std::string& where) {
    for (size_t i = 0; i < image.rgba32f.size(); ++i)
        if (!std::isfinite(image.rgba32f[i]))
            fail_input("{}: the texel in column {}, row {} of the image is not finite", where,
                       i / 4 % image.width, i / 4 / image.width);
}

ImageDescription decode_exr(std::span<const uint8_t> bytes, const std::string& where) {
    Image exr = read_exr(std::as_bytes(bytes), where);
    check_size(exr.width, exr.height, where);
    std::array<size_t, 3> channels = picture_channels(exr);
    int alpha = find_channel(exr, "A");
    ImageDescription image;
    image.width = exr.width, image.height = exr.height;
    image.rgba32f.resize(4 * pixel_count(exr));
    for (size_t c = 0; c < 4; ++c) {
        std::span<const float> from;
        if (c < 3 || alpha >= 0) from = plane(std::as_const(exr), c < 3 ? channels[c] : size_t(alpha));
        for (size_t i = 0; i < pixel_count(exr); ++i)
            image.rgba32f[4 * i + c] = from.empty() ? 1.0f : from[i];
    }
    return image;
}

bool is_webp(std::span<const uint8_t> bytes) {
    return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
           std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

ImageDescription decode_webp(std::span<const uint8_t> bytes, const std::string& where) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
        fail_input("{}: the WebP image is damaged", where);
    if (features.has_animation) fail_input("{}: the WebP image moves; allowed: one picture", where);
    check_size(uint64_t(features.width), uint64_t(features.height), where);
    ImageDescription image;
    image.width = uint32_t(features.width), image.height = uint32_t(features.height);
    image.rgba8.resize(4 * size_t(image.width) * image.height);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba8.data(), image.rgba8.size(),
                            4 * features.width))
        fail_input("{}: the WebP image is damaged or truncated", where);
    return image;
}

bool is_exr(std::span<const uint8_t> bytes) {
    return bytes.size() >= 4 && bytes[0] == 0x76 && bytes[1] == 0x2F && bytes[2] == 0x31 && bytes[3] == 0x01;
}

}  // namespace

ImageDescription decode_image(std::span<const uint8_t> bytes, const std::string& where) {
    ImageDescription image;
    if (is_exr(bytes)) {
        image = decode_exr(bytes, where);
    } else if (is_webp(bytes)) {
        image = decode_webp(bytes, where);
    } else if (is_radiance(bytes)) {
        image = decode_radiance(bytes, where, max_texels);
    } else {
        if (!bytes.empty() && bytes[0] == 0xFF) check_jpeg_tables(bytes, where);
        int width = 0, height = 0, channels = 0, size = int(std::min(bytes.size(), size_t(INT_MAX)));
        if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
            fail_input("{}: not an image that can be read; PNG, JPEG, WebP, Radiance .hdr and OpenEXR are",
                       where);
        check_size(uint64_t(width), uint64_t(height), where);
        image.width = uint32_t(width), image.height = uint32_t(height);
        Source source{bytes};
        std::unique_ptr<uint8_t, StbiFree> pixels(
            stbi_load_from_callbacks(&source_callbacks, &source, &width, &height, &channels, 4));
        if (source.ran_out) fail_input("{}: the image is truncated", where);
        if (!pixels) fail_input("{}: the image is damaged: {}", where, stbi_failure_reason());
        image.rgba8.assign(pixels.get(), pixels.get() + 4 * size_t(width) * size_t(height));
    }
    check_finite(image, where);
    return image;
}

ImageDescription read_image_file(const std::filesystem::path& file) {
    std::vector<std::byte> bytes = read_whole_file(file);
    ImageDescription image =
        decode_image({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, file.string());
    image.name = file.filename().string();
    return image;
}

}  // namespace etendue
