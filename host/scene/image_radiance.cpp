#include "host/scene/image_radiance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "host/error.h"

namespace etendue {
namespace {

struct Reader {
    std::span<const uint8_t> bytes;
    size_t at = 0;
    const std::string& where;

    uint8_t next() {
        if (at >= bytes.size()) fail_input("{}: the image is truncated", where);
        return bytes[at++];
    }
    std::string line() {
        std::string text;
        for (uint8_t c = next(); c != '\n'; c = next()) text += char(c);
        return text;
    }
};

// One component of a row: runs of 129 to 255 (minus 128) equal bytes, or 1 to 128 bytes as they are.
void read_component(Reader& reader, size_t width, uint8_t* out) {
    for (size_t i = 0; i < width;) {
        size_t count = reader.next();
        bool run = count > 128;
        if (run) count -= 128;
        if (count == 0 || count > width - i)
            fail_input("{}: the image is damaged: a run leaves its row", reader.where);
        uint8_t value = run ? reader.next() : 0;
        for (size_t k = 0; k < count; ++k) out[4 * i++] = run ? value : reader.next();
    }
}

// A row of whole texels; (1, 1, 1, n) repeats the one before, n shifted by 8 bits more with each such texel
// in a row.
void read_flat_row(Reader& reader, size_t width, uint8_t* out) {
    int shift = 0;
    for (size_t i = 0; i < width;) {
        uint8_t texel[4];
        for (uint8_t& byte : texel) byte = reader.next();
        if (i == 0 || texel[0] != 1 || texel[1] != 1 || texel[2] != 1) {
            std::memcpy(out + 4 * i++, texel, 4);
            shift = 0;
            continue;
        }
        size_t count = shift < 32 ? size_t(texel[3]) << shift : SIZE_MAX;
        if (count > width - i) fail_input("{}: the image is damaged: a run leaves its row", reader.where);
        for (size_t k = 0; k < count; ++k, ++i) std::memcpy(out + 4 * i, out + 4 * (i - 1), 4);
        shift += 8;
    }
}

}  // namespace

bool is_radiance(std::span<const uint8_t> bytes) {
    auto starts = [&](const char* text) {
        return bytes.size() >= std::strlen(text) && std::memcmp(bytes.data(), text, std::strlen(text)) == 0;
    };
    return starts("#?RADIANCE\n") || starts("#?RGBE\n");
}

ImageDescription decode_radiance(std::span<const uint8_t> bytes, const std::string& where,
                                 uint64_t max_texels) {
    Reader reader{bytes, 0, where};
    for (std::string line = reader.line(); !line.empty(); line = reader.line())
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            fail_input("{}: the image has the format '{}'; 32-bit_rle_rgbe can be read", where,
                       line.substr(7));
    std::string size = reader.line();
    unsigned long long width = 0, height = 0;
    if (std::sscanf(size.c_str(), "-Y %19llu +X %19llu", &height, &width) != 2)
        fail_input("{}: the image is not stored in rows from the top ('-Y HEIGHT +X WIDTH')", where);
    if (width == 0 || height == 0 || width > max_texels || height > max_texels / width)
        fail_input("{}: the image has {} x {} texels; 1 to {} are allowed", where, width, height, max_texels);

    ImageDescription image;
    image.width = uint32_t(width), image.height = uint32_t(height);
    std::vector<uint8_t> row(4 * width);
    for (size_t y = 0; y < height; ++y) {
        bool by_component = width >= 8 && width < 32768 && bytes.size() - reader.at >= 4 &&
                            bytes[reader.at] == 2 && bytes[reader.at + 1] == 2 && bytes[reader.at + 2] < 128;
        if (by_component) {
            size_t stored = size_t(bytes[reader.at + 2]) << 8 | bytes[reader.at + 3];
            if (stored != width) fail_input("{}: the image is damaged: a row has another length", where);
            reader.at += 4;
            for (size_t c = 0; c < 4; ++c) read_component(reader, width, row.data() + c);
        } else {
            read_flat_row(reader, width, row.data());
        }
        // Grows with what is read: a header alone cannot ask for memory.
        for (size_t x = 0; x < width; ++x) {
            const uint8_t* texel = row.data() + 4 * x;
            float scale = texel[3] == 0 ? 0.0f : std::ldexp(1.0f, int(texel[3]) - 136);
            image.rgba32f.insert(image.rgba32f.end(),
                                 {texel[0] * scale, texel[1] * scale, texel[2] * scale, 1.0f});
        }
    }
    return image;
}

}  // namespace etendue
