#include "host/render/film.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace etendue {
namespace {

// Twin of struct FilmPixel in shaders/lib/film.glsl.
struct FilmPixel {
    glm::vec3 sum;
    float samples;
    glm::vec3 compensation;
    float reserved;
    glm::vec3 squares;
    float reserved_squares;
};

}  // namespace

Film::Film(Device& device, uint32_t width, uint32_t height, uint64_t binding_bytes)
    : width_(width),
      height_(height),
      pixels_(device, uint64_t(width) * height * sizeof(FilmPixel), "Film"),
      address_(create_buffer(device, std::vector<uint64_t>{pixels_.address()}, "FilmAddress")),
      by_address_(pixels_.bytes() > binding_bytes) {
    clear();
}

BufferTable Film::buffers() const { return {{"Film", &pixels_}, {"FilmAddress", &address_}}; }

void Film::clear() { pixels_.fill(0); }

std::vector<std::byte> Film::read() const {
    return pixels_.read_array<std::byte>(uint64_t(width_) * height_ * sizeof(FilmPixel));
}

void Film::write(const std::vector<std::byte>& pixels) { pixels_.write(pixels.data(), pixels.size()); }

Image Film::develop() const {
    Image image;
    image.width = width_, image.height = height_;
    const auto pixels = pixels_.read_array<FilmPixel>(pixel_count(image));
    std::vector<glm::vec3> means(pixels.size()), errors(pixels.size());
    for (size_t i = 0; i < pixels.size(); ++i) {
        const FilmPixel& p = pixels[i];
        const double n = p.samples;
        if (n == 0) continue;
        for (int c = 0; c < 3; ++c) {
            const double mean = (double(p.sum[c]) + double(p.compensation[c])) / n;
            means[i][c] = float(mean);
            const double variance = std::max(0.0, double(p.squares[c]) / n - mean * mean);
            errors[i][c] = n > 1 ? float(std::sqrt(variance / (n - 1))) : INFINITY;
        }
    }
    const auto floats = [](const std::vector<glm::vec3>& v) {
        return std::span<const float>(&v[0].x, 3 * v.size());
    };
    add_channels(image, {"R", "G", "B"}, floats(means), 3);
    add_channels(image, {"error.R", "error.G", "error.B"}, floats(errors), 3);
    return image;
}

double estimated_relative_error(const Image& image) {
    double sum = 0;
    for (const char* channel : {"R", "G", "B"}) {
        const int value = find_channel(image, channel),
                  error = find_channel(image, std::string("error.") + channel);
        if (value < 0 || error < 0) return INFINITY;
        const auto values = plane(image, size_t(value)), errors = plane(image, size_t(error));
        double mean = 0;
        for (float v : values) mean += v;
        mean /= double(values.size());
        const double floor = std::max(0.01 * mean * mean, 1e-300);
        for (size_t i = 0; i < values.size(); ++i) {
            if (std::isinf(errors[i])) return INFINITY;
            sum += double(errors[i]) * errors[i] / (double(values[i]) * values[i] + floor) /
                   (3.0 * double(values.size()));
        }
    }
    return std::sqrt(sum);
}

}  // namespace etendue
