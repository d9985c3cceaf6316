#include "host/render/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace etendue {

Film::Film(Device& device, uint32_t width, uint32_t height, bool merging, bool stokes)
    : width_(width),
      height_(height),
      layers_(stokes ? 4 : 1),
      merging_(merging),
      pixels_(device, bytes(), "Film") {}

uint64_t Film::bytes() const {
    return uint64_t(width_) * height_ * layers_ * (sizeof(FilmPixel) + (merging_ ? sizeof(FilmBias) : 0));
}

BufferTable Film::buffers() const { return {{"Film", &pixels_}}; }

void Film::resize(uint32_t width, uint32_t height) { width_ = width, height_ = height; }

void Film::clear() { pixels_.fill(0, bytes()); }

std::vector<std::byte> Film::read() const { return pixels_.read_array<std::byte>(bytes()); }

void Film::write(const std::vector<std::byte>& pixels) { pixels_.write(pixels.data(), pixels.size()); }

FilmSums Film::sums(uint32_t layer) const {
    FilmSums sums{width_, height_, {}, {}};
    const std::vector<std::byte> bytes = read();
    const size_t stride = sizeof(FilmPixel) + (merging_ ? sizeof(FilmBias) : 0);
    for (size_t at = layer * stride; at < bytes.size(); at += layers_ * stride) {
        std::memcpy(&sums.pixels.emplace_back(), &bytes[at], sizeof(FilmPixel));
        if (merging_)
            std::memcpy(&sums.bias.emplace_back(), &bytes[at + sizeof(FilmPixel)], sizeof(FilmBias));
    }
    return sums;
}

Image Film::develop(bool errors) const {
    Image image;
    image.width = width_, image.height = height_;
    const auto add = [&](const std::string& name, const std::vector<glm::vec3>& colors) {
        add_channels(image, {name + "R", name + "G", name + "B"},
                     std::span<const float>(&colors[0].x, 3 * colors.size()), 3);
    };
    for (uint32_t layer = 0; layer < layers_; ++layer) {
        const FilmSums film = sums(layer);
        const std::string name = layer == 0 ? "" : fmt::format("S{}.", layer);
        std::vector<glm::vec3> means;
        means.reserve(film.pixels.size());
        for (const FilmPixel& p : film.pixels) means.push_back(mean(p));
        add(name, means);
        if (errors) add("error." + name, estimate_errors(film));
    }
    return image;
}

RelativeError Film::relative_error() const { return estimate_relative_error(sums(0)); }

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
