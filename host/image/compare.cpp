#include "host/image/compare.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/error.h"
#include "host/image/polarization.h"

namespace etendue {
namespace {

using Planes = std::vector<std::span<const float>>;

bool is_layer(const std::string& channel) {
    for (const char* layer : {"albedo.", "normal.", "depth.", "error.", "polarization.", "S1.", "S2.", "S3."})
        if (channel.starts_with(layer)) return true;
    return false;
}

std::vector<std::string> own_channels(const Image& image) {
    if (find_channel(image, "R") >= 0 && find_channel(image, "G") >= 0 && find_channel(image, "B") >= 0)
        return {"R", "G", "B"};
    std::vector<std::string> names;
    for (const std::string& channel : image.channels)
        if (!is_layer(channel) && channel != "A") names.push_back(channel);
    std::sort(names.begin(), names.end());
    return names;
}

Planes select(const Image& image, const std::vector<std::string>& channels) {
    Planes planes;
    for (const std::string& channel : channels)
        planes.push_back(plane(image, size_t(find_channel(image, channel))));
    return planes;
}

bool is_finite(const Planes& planes, size_t pixel) {
    for (auto values : planes)
        if (!std::isfinite(values[pixel])) return false;
    return true;
}

// 0/0 is no difference: both are black where the reference is black everywhere.
double ratio(double numerator, double denominator) {
    if (numerator == 0) return 0;
    return denominator == 0 ? std::copysign(std::numeric_limits<double>::infinity(), numerator)
                            : numerator / denominator;
}

std::vector<float> values_at(const Planes& planes, size_t pixel) {
    std::vector<float> values;
    for (auto plane : planes) values.push_back(plane[pixel]);
    return values;
}

StokesComparison compare_stokes(const Image& image, const Image& reference,
                                const std::vector<size_t>& pixels) {
    StokesComparison result;
    std::vector<std::string> names;
    double intensity = 0;
    const auto values = [](const Image& of, const std::string& name) {
        return plane(of, size_t(find_channel(of, name)));
    };
    for (const char* channel : {"R", "G", "B"}) {
        const auto s0 = values(reference, channel);
        for (size_t p : pixels) intensity += s0[p] / double(3 * pixels.size());
        for (int k = 0; k < 3; ++k) {
            names.push_back(fmt::format("S{}.{}", k + 1, channel));
            const auto a = values(image, names.back()), b = values(reference, names.back());
            for (size_t p : pixels) {
                const double difference = double(a[p]) - double(b[p]);
                result.rms[size_t(k)] += difference * difference / double(3 * pixels.size());
                result.bias[size_t(k)] += difference / double(3 * pixels.size());
            }
        }
    }
    for (size_t k = 0; k < 3; ++k) {
        result.rms[k] = ratio(std::sqrt(result.rms[k]), intensity);
        result.bias[k] = ratio(result.bias[k], intensity);
    }
    result.z_test = z_test(image, reference, names);
    result.tile_test = z_test(image, reference, names, z_tile);
    return result;
}

// Names of the spectral layout for OpenEXR (Fichet et al. 2021), as host/render/spectral_film.h writes them.
std::vector<std::string> spectral_bins(const Image& image) {
    std::vector<std::string> names;
    for (const std::string& channel : image.channels)
        if (channel.starts_with("S0.") && channel.ends_with("nm")) names.push_back(channel);
    std::sort(names.begin(), names.end());
    return names;
}

std::optional<SpectraComparison> compare_spectra(const Image& image, const Image& reference,
                                                 const std::vector<size_t>& pixels) {
    const std::vector<std::string> bins = spectral_bins(image), others = spectral_bins(reference);
    if (bins.empty() && others.empty()) return std::nullopt;
    SpectraComparison result;
    if (bins != others) return result;
    result.bins = bins.size();
    const Planes a = select(image, bins), b = select(reference, bins);
    const double count = double(pixels.size() * bins.size());
    double total_a = 0, total_b = 0;
    for (size_t bin = 0; bin < bins.size(); ++bin) {
        double sum_a = 0, sum_b = 0;
        for (size_t p : pixels) sum_a += a[bin][p], sum_b += b[bin][p];
        total_a += sum_a, total_b += sum_b;
        const double bias = ratio(sum_a - sum_b, sum_b);
        if (std::abs(bias) > std::abs(result.worst_bias))
            result.worst_bias = bias, result.worst_bin = bins[bin];
    }
    result.bias = ratio(total_a - total_b, total_b);
    const double mean = total_b / count, floor = 0.01 * mean * mean;
    for (size_t bin = 0; bin < bins.size(); ++bin)
        for (size_t p : pixels) {
            const double r = b[bin][p], d = double(a[bin][p]) - r;
            result.relmse += ratio(d * d, r * r + floor) / count;
        }
    return result;
}

}  // namespace

Comparison compare_images(const Image& image, const Image& reference, const std::string& image_name,
                          const std::string& reference_name, size_t worst_pixels) {
    if (image.width != reference.width || image.height != reference.height)
        fail_input("{} is {} x {} pixels, {} is {} x {}: the sizes must be equal", image_name, image.width,
                   image.height, reference_name, reference.width, reference.height);
    Comparison result;
    result.width = image.width, result.height = image.height;
    result.channels = own_channels(image);
    auto others = own_channels(reference);
    if (result.channels != others || others.empty())
        fail_input("{} has the channels {}, {} has {}: they must be equal", image_name,
                   fmt::join(result.channels, " "), reference_name, fmt::join(others, " "));

    Planes a = select(image, result.channels), b = select(reference, result.channels);
    size_t channel_count = result.channels.size();
    std::vector<size_t> finite;  // pixels
    std::vector<double> sum_a(channel_count), sum_b(channel_count);
    for (size_t p = 0; p < pixel_count(image); ++p) {
        bool finite_a = is_finite(a, p), finite_b = is_finite(b, p);
        result.nonfinite_image += !finite_a, result.nonfinite_reference += !finite_b;
        if (!finite_a || !finite_b) continue;
        finite.push_back(p);
        for (size_t c = 0; c < channel_count; ++c) sum_a[c] += a[c][p], sum_b[c] += b[c][p];
    }
    double count = double(finite.size() * channel_count);
    double total_a = 0, total_b = 0;
    for (size_t c = 0; c < channel_count; ++c) {
        total_a += sum_a[c], total_b += sum_b[c];
        result.channel_bias.push_back(ratio(sum_a[c] - sum_b[c], sum_b[c]));
    }
    result.bias = ratio(total_a - total_b, total_b);
    if (finite.empty()) return result;

    double mean_b = total_b / count, floor = 0.01 * mean_b * mean_b;
    double sum_squared = 0, sum_relative = 0;
    std::vector<std::pair<double, size_t>> ranking;
    ranking.reserve(finite.size());
    for (size_t p : finite) {
        double relative = 0;
        for (size_t c = 0; c < channel_count; ++c) {
            double r = b[c][p], d = double(a[c][p]) - r;
            sum_squared += d * d;
            relative += ratio(d * d, r * r + floor);
        }
        sum_relative += relative;
        ranking.emplace_back(relative / double(channel_count), p);
    }
    result.relmse = sum_relative / count;
    result.rmse = std::sqrt(sum_squared / count);

    size_t kept = std::min(worst_pixels, ranking.size());
    std::partial_sort(
        ranking.begin(), ranking.begin() + ptrdiff_t(kept), ranking.end(),
        [](auto& l, auto& r) { return l.first != r.first ? l.first > r.first : l.second < r.second; });
    for (size_t i = 0; i < kept && ranking[i].first > 0; ++i) {
        size_t p = ranking[i].second;
        result.worst.push_back({uint32_t(p % image.width), uint32_t(p / image.width), ranking[i].first,
                                values_at(a, p), values_at(b, p)});
    }
    result.z_test = z_test(image, reference, result.channels);
    result.tile_test = z_test(image, reference, result.channels, z_tile);
    if (has_stokes(image) && has_stokes(reference)) result.stokes = compare_stokes(image, reference, finite);
    result.spectra = compare_spectra(image, reference, finite);
    return result;
}

}  // namespace etendue
