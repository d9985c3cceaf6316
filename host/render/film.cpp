#include "host/render/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

// Of samples beside the film, so that its sums are read and written seldom; passes at most as MOST_ADDENDS of
// shaders/lib/exact_sum.glsl allows.
constexpr uint64_t most_samples = 1 << 21, least_passes = 4, most_passes = 256;

// Of one layer of every pixel.
FilmSums layer_sums(const FilmShape& shape, std::span<const ExactSum> sums, const PassSet& passes,
                    uint32_t layer) {
    const size_t stride = shape.sums_a_layer(), pixels = size_t(shape.width) * shape.height;
    FilmSums film{shape.width, shape.height, passes.even(), passes.count() - passes.even(), {}, {}};
    film.pixels.resize(pixels);
    if (shape.merging) film.bias.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) {
        const ExactSum* at = &sums[(i * shape.layers() + layer) * stride];
        for (size_t half = 0; half < 2; ++half, at += stride / 2) {
            film.pixels[i].sums[half] = value(at[0]);
            film.pixels[i].squares[half] = value(at[1]);
            if (shape.merging) film.bias[i].sums[half] = value(at[2]);
        }
    }
    return film;
}

}  // namespace

std::string FilmShape::defines() const {
    return fmt::format("#define MERGE_VERTICES {:d}\n#define STOKES_IMAGE {:d}\n#define LIGHT_LAYERS {}\n",
                       merging, stokes, light_layers.size());
}

Film::Film(Device& device, Scene& scene, const FilmShape& shape, KernelTimings& timings)
    : ends_loops_early_(device.description.max_loop_turns > 0),
      shape_(shape),
      timings_(timings),
      commands_(device),
      sums_(device, shape.sums() * sizeof(ExactSum), "Film") {
    const uint64_t pixels = uint64_t(shape.width) * shape.height;
    const uint64_t images = 1 + shape.light_layers.size();
    sample_passes_ =
        uint32_t(std::clamp<uint64_t>(most_samples / (pixels * images), least_passes, most_passes));
    samples_ =
        Buffer(device, pixels * shape.layers() * sample_passes_ * (shape.merging ? 2 : 1) * sizeof(glm::vec3),
               "Samples");
    accumulate_film_ =
        make_color_kernel(device, scene, "kernels/accumulate_film.comp", buffers(), shape.defines());
}

BufferTable Film::buffers() const { return {{"Film", &sums_}, {"Samples", &samples_}}; }

uint32_t Film::begin_passes(uint64_t first, uint32_t wanted) {
    if (not_added_.end != first || not_added_.count() == sample_passes_ || ends_loops_early_) add_samples();
    if (ends_loops_early_) samples_.fill(0);
    if (not_added_.count() == 0) not_added_ = {first, first};
    const uint32_t count = std::min(wanted, sample_passes_ - uint32_t(not_added_.count()));
    not_added_.end += count;
    return count;
}

void Film::add_samples() {
    if (not_added_.count() == 0) return;
    const uint32_t pixels = shape_.width * shape_.height, size = accumulate_film_.group_size();
    commands_.dispatch(accumulate_film_,
                       std::clamp((pixels * shape_.layers() + size - 1) / size, 1u, max_groups),
                       {{"pixels", pixels},
                        {"sample_passes", sample_passes_},
                        {"first_pass", uint32_t(not_added_.first)},
                        {"passes", uint32_t(not_added_.count())}});
    commands_.run(&timings_);
    not_added_ = {};
}

void Film::warm_up() {
    commands_.dispatch(accumulate_film_, 1);
    commands_.run();
}

void Film::resize(uint32_t pixels) {
    not_added_ = {};
    shape_.width = pixels, shape_.height = 1;
}

void Film::clear() {
    not_added_ = {};
    sums_.fill(0, shape_.sums() * sizeof(ExactSum));
}

std::vector<ExactSum> Film::read() {
    add_samples();
    return sums_.read_array<ExactSum>(shape_.sums());
}

void Film::write(const std::vector<ExactSum>& sums) {
    not_added_ = {};
    sums_.write(sums.data(), sums.size() * sizeof(ExactSum));
}

Image develop_film(const FilmShape& shape, std::span<const ExactSum> sums, const PassSet& passes,
                   bool errors) {
    Image image;
    image.width = shape.width, image.height = shape.height;
    const auto add = [&](const std::string& name, const std::vector<glm::vec3>& colors) {
        add_channels(image, {name + "R", name + "G", name + "B"},
                     std::span<const float>(&colors[0].x, 3 * colors.size()), 3);
    };
    for (uint32_t layer = 0; layer < shape.layers(); ++layer) {
        const FilmSums film = layer_sums(shape, sums, passes, layer);
        const std::string name = layer == 0     ? ""
                                 : shape.stokes ? fmt::format("S{}.", layer)
                                                : shape.light_layers[layer - 1] + ".";
        std::vector<glm::vec3> means;
        means.reserve(film.pixels.size());
        for (const FilmPixel& p : film.pixels) means.push_back(mean(film, p));
        add(name, means);
        if (errors) add("error." + name, estimate_errors(film));
    }
    return image;
}

RelativeError film_relative_error(const FilmShape& shape, std::span<const ExactSum> sums,
                                  const PassSet& passes) {
    return estimate_relative_error(layer_sums(shape, sums, passes, 0));
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
