#include "host/measured/maps.h"

#include <algorithm>

#include "host/error.h"
#include "host/spectra/color.h"

namespace etendue {

uint32_t add_numbers(MeasuredBsdf& bsdf, std::span<const double> numbers) {
    const uint32_t first = uint32_t(bsdf.points.size());
    for (const double x : numbers) bsdf.points.emplace_back(float(x), 0.0f);
    return first;
}

MeasuredMap add_map(MeasuredBsdf& bsdf, std::span<const float> values, std::span<const double> columns,
                    std::span<const double> rows, bool normalize) {
    const size_t width = columns.size(), height = rows.size(), count = width * height;
    const MeasuredMap map{uint32_t(bsdf.points.size()), uint32_t(width), uint32_t(height)};
    // Integrals in double precision: differences of sums decide where samples go.
    std::vector<double> slice(count), along(count), row_sums(height);
    for (size_t first = 0; first < values.size(); first += count) {
        slice.assign(values.begin() + ptrdiff_t(first), values.begin() + ptrdiff_t(first + count));
        for (int attempt = 0; attempt < 2; ++attempt) {
            for (size_t y = 0; y < height; ++y) {
                along[y * width] = 0;
                for (size_t i = y * width + 1, x = 1; x < width; ++i, ++x)
                    along[i] = along[i - 1] + 0.5 * (slice[i - 1] + slice[i]) * (columns[x] - columns[x - 1]);
            }
            row_sums[0] = 0;
            for (size_t y = 1; y < height; ++y)
                row_sums[y] = row_sums[y - 1] + 0.5 * (along[y * width - 1] + along[(y + 1) * width - 1]) *
                                                    (rows[y] - rows[y - 1]);
            if (!normalize || row_sums.back() > 0) break;
            std::fill(slice.begin(), slice.end(), 1.0);
        }
        const double scale = normalize ? 1 / row_sums.back() : 1;
        for (size_t y = 0; y < height; ++y)
            bsdf.points.emplace_back(float(row_sums[y] * scale), float(along[(y + 1) * width - 1] * scale));
        for (size_t i = 0; i < count; ++i)
            bsdf.points.emplace_back(float(slice[i] * scale), float(along[i] * scale));
    }
    return map;
}

namespace {

// What each wavelength's value contributes to the colour under D65, linear in between.
std::vector<glm::dvec3> channel_colors(std::span<const double> wavelengths) {
    std::vector<glm::dvec3> colors;
    std::vector<double> hat(wavelengths.size(), 0.0);
    for (size_t i = 0; i < wavelengths.size(); ++i) {
        hat[i] = 1;
        colors.push_back(rgb_of_radiance(interpolate(wavelengths, hat, Outside::hold) * white_light()));
        hat[i] = 0;
    }
    return colors;
}

}  // namespace

SpectralTable channel_places(std::span<const double> wavelengths) {
    std::vector<double> numbers(wavelengths.size());
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = double(i);
    return interpolate(wavelengths, numbers, Outside::hold);
}

std::pair<size_t, size_t> visible_channels(std::span<const double> wavelengths) {
    size_t begin = 0, end = wavelengths.size();
    while (begin + 1 < end && wavelengths[begin + 1] <= first_nm) ++begin;
    while (end > begin + 1 && wavelengths[end - 2] >= last_nm) --end;
    return {begin, end};
}

void add_channels(MeasuredBsdf& bsdf, std::span<const float> values, std::span<const double> wavelengths) {
    if (wavelengths.empty()) {
        bsdf.colors.assign(values.begin(), values.end());
        return;
    }
    const size_t channels = wavelengths.size(), points = values.size() / channels;
    const std::vector<glm::dvec3> weights = channel_colors(wavelengths);
    for (size_t p = 0; p < points; ++p) {
        glm::dvec3 rgb(0);
        for (size_t i = 0; i < channels; ++i) rgb += double(values[p * channels + i]) * weights[i];
        for (int k = 0; k < 3; ++k) bsdf.colors.push_back(float(std::max(rgb[k], 0.0)));
    }
    // Wavelengths that no path carries need no memory.
    const auto [begin, end] = visible_channels(wavelengths);
    bsdf.ref.channels = uint32_t(end - begin);
    bsdf.spectra.reserve(points * (end - begin));
    for (size_t p = 0; p < points; ++p)
        bsdf.spectra.insert(bsdf.spectra.end(), values.begin() + ptrdiff_t(p * channels + begin),
                            values.begin() + ptrdiff_t(p * channels + end));
    bsdf.place.table = channel_places(wavelengths.subspan(begin, end - begin));
}

MeasuredRef append(MeasuredBsdf& all, const MeasuredBsdf& one) {
    MeasuredRef ref = one.ref;
    const size_t most = 0xFFFFFFFFu;
    if (all.points.size() + one.points.size() > most || all.colors.size() + one.colors.size() > most ||
        all.spectra.size() + one.spectra.size() > most)
        fail_input("too many measured surfaces: their numbers exceed 2^32");
    for (uint32_t* first : {&ref.theta_first, &ref.phi_first, &ref.swept_first, &ref.turn_first,
                            &ref.density.first, &ref.visible.first, &ref.normals.first, &ref.area.first})
        *first += uint32_t(all.points.size());
    ref.colors = uint32_t(all.colors.size()), ref.spectra = uint32_t(all.spectra.size());
    all.points.insert(all.points.end(), one.points.begin(), one.points.end());
    all.colors.insert(all.colors.end(), one.colors.begin(), one.colors.end());
    all.spectra.insert(all.spectra.end(), one.spectra.begin(), one.spectra.end());
    return ref;
}

std::vector<double> even_coordinates(size_t count) {
    std::vector<double> result(count);
    for (size_t i = 0; i < count; ++i) result[i] = double(i) / double(count - 1);
    return result;
}

}  // namespace etendue
