#include "host/render/film.h"

#include <algorithm>
#include <cmath>

namespace etendue {

Film::Film(Device& device, uint32_t width, uint32_t height, bool merging)
    : width_(width),
      height_(height),
      merging_(merging),
      pixels_(device, uint64_t(width) * height * pixel_bytes(), "Film") {}

uint64_t Film::pixel_bytes() const { return sizeof(FilmPixel) + (merging_ ? sizeof(FilmBias) : 0); }

BufferTable Film::buffers() const { return {{"Film", &pixels_}}; }

void Film::resize(uint32_t width, uint32_t height) { width_ = width, height_ = height; }

void Film::clear() { pixels_.fill(0, uint64_t(width_) * height_ * pixel_bytes()); }

std::vector<std::byte> Film::read() const {
    return pixels_.read_array<std::byte>(uint64_t(width_) * height_ * pixel_bytes());
}

void Film::write(const std::vector<std::byte>& pixels) { pixels_.write(pixels.data(), pixels.size()); }

FilmSums Film::sums() const {
    FilmSums sums{width_, height_, {}, {}};
    const size_t count = size_t(width_) * height_;
    if (!merging_) {
        sums.pixels = pixels_.read_array<FilmPixel>(count);
        return sums;
    }
    struct MergingPixel {
        FilmPixel pixel;
        FilmBias bias;
    };
    static_assert(sizeof(MergingPixel) == sizeof(FilmPixel) + sizeof(FilmBias));
    for (const MergingPixel& p : pixels_.read_array<MergingPixel>(count)) {
        sums.pixels.push_back(p.pixel);
        sums.bias.push_back(p.bias);
    }
    return sums;
}

Image Film::develop(bool errors) const {
    Image image;
    image.width = width_, image.height = height_;
    const FilmSums film = sums();
    std::vector<glm::vec3> means;
    means.reserve(film.pixels.size());
    for (const FilmPixel& p : film.pixels) means.push_back(mean(p));
    const auto floats = [](const std::vector<glm::vec3>& v) {
        return std::span<const float>(&v[0].x, 3 * v.size());
    };
    add_channels(image, {"R", "G", "B"}, floats(means), 3);
    if (errors) add_channels(image, {"error.R", "error.G", "error.B"}, floats(estimate_errors(film)), 3);
    return image;
}

RelativeError Film::relative_error() const { return estimate_relative_error(sums()); }

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
