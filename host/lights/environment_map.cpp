#include "host/lights/environment_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "host/error.h"

namespace etendue {
namespace {

double luminance(const glm::uvec4& texel) {  // Rec.709
    const auto c = std::bit_cast<std::array<float, 4>>(texel);
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

glm::uvec4 pack(float x, float y, float z) {
    return {std::bit_cast<uint32_t>(x), std::bit_cast<uint32_t>(y), std::bit_cast<uint32_t>(z), 0};
}

float srgb_to_linear(float v) {  // IEC 61966-2-1
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

glm::uvec4 read_texel(const ImageDescription& image, uint32_t x, uint32_t y) {
    const size_t at = (size_t(y) * image.width + x) * 4;
    if (image.rgba32f.empty()) {
        const uint8_t* p = &image.rgba8[at];
        return pack(srgb_to_linear(p[0] / 255.0f), srgb_to_linear(p[1] / 255.0f),
                    srgb_to_linear(p[2] / 255.0f));
    }
    const float* p = &image.rgba32f[at];
    for (int c = 0; c < 3; ++c)
        if (!(p[c] >= 0) || std::isinf(p[c]))
            fail_input(
                "{}: the texel in column {}, row {} of this environment image is {}; radiance is a finite "
                "number, "
                "at least 0",
                image.name, x, y, p[c]);
    return pack(p[0], p[1], p[2]);
}

// Polar angle of the upper edge of cell row j. Edges lie at the poles and along the centres of the image's
// rows.
double edge_angle(uint32_t j, uint32_t height) {
    if (j == 0) return 0;
    return j > height ? std::numbers::pi : std::numbers::pi * (j - 0.5) / height;
}

}  // namespace

AliasTable build_alias_table(std::span<const double> weights) {
    const size_t n = weights.size();
    AliasTable table{std::vector<double>(n, 1.0), std::vector<uint32_t>(n)};
    double sum = 0;
    for (double w : weights) sum += w;
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < n; ++i) {
        table.alias[i] = i;
        if (sum > 0) table.threshold[i] = weights[i] / sum * double(n);
        (table.threshold[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t s = small.back(), l = large.back();
        small.pop_back();
        table.alias[s] = l;
        table.threshold[l] = (table.threshold[l] + table.threshold[s]) - 1;
        if (table.threshold[l] < 1) large.pop_back(), small.push_back(l);
    }
    // What rounding leaves over is 1 in exact arithmetic.
    for (uint32_t i : small) table.threshold[i] = 1;
    for (uint32_t i : large) table.threshold[i] = 1;
    return table;
}

EnvironmentMap build_environment_map(const ImageDescription& image) {
    const uint32_t width = image.width, height = image.height;
    const size_t texel_count = size_t(width) * height;
    if (width == 0 || height == 0 || width > 65536 || height > 65536)
        fail_input("{}: an environment image is 1 to 65536 texels wide and high, not {} x {}", image.name,
                   width, height);
    if (image.rgba32f.size() != texel_count * 4 && image.rgba8.size() != texel_count * 4)
        fail_input("{}: the image holds too few texels for {} x {}", image.name, width, height);

    EnvironmentMap map;
    map.texels.resize((size_t(height) + 2) * width + height + 1);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) map.texels[size_t(y + 1) * width + x] = read_texel(image, x, y);
    std::copy_n(map.texels.begin() + width, width, map.texels.begin());
    std::copy_n(map.texels.begin() + size_t(height) * width, width,
                map.texels.begin() + size_t(height + 1) * width);

    const uint32_t alias_bits = std::max<uint32_t>(1, uint32_t(std::bit_width(width - 1)));
    const double threshold_scale = std::exp2(32 - int(alias_bits));
    std::vector<double> row_weights(height + 1), cells(width);
    double integral = 0;
    for (uint32_t j = 0; j <= height; ++j) {
        glm::uvec4* top = &map.texels[size_t(j) * width];
        const glm::uvec4* bottom = top + width;
        double sum = 0;
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t right = x + 1 < width ? x + 1 : 0;
            cells[x] = 0.25 * (luminance(top[x]) + luminance(top[right]) + luminance(bottom[x]) +
                               luminance(bottom[right]));
            sum += cells[x];
        }
        const double a = edge_angle(j, height), b = edge_angle(j + 1, height);
        const double edge_height = 2 * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a));  // cos a - cos b
        const double nearer = 2 * j > height ? std::numbers::pi - b : a;
        row_weights[j] = sum * edge_height;
        integral += row_weights[j] * (2 * std::numbers::pi / width);
        const AliasTable table = build_alias_table(cells);
        for (uint32_t x = 0; x < width; ++x) {
            const double threshold =
                std::min(std::round(table.threshold[x] * threshold_scale), threshold_scale - 1);
            // Where rounding could lead away from a column that is always its own: its alias is itself.
            top[x].w = uint32_t(threshold) << alias_bits | table.alias[x];
        }
        glm::uvec4& row = map.texels[(size_t(height) + 2) * width + j];
        row.z = std::bit_cast<uint32_t>(float(2 * std::sin(0.5 * nearer) * std::sin(0.5 * nearer)));
        row.w = std::bit_cast<uint32_t>(float(edge_height));
    }
    const AliasTable rows = build_alias_table(row_weights);
    for (uint32_t j = 0; j <= height; ++j) {
        glm::uvec4& row = map.texels[(size_t(height) + 2) * width + j];
        row.x = std::bit_cast<uint32_t>(float(rows.threshold[j]));
        row.y = rows.alias[j];
    }
    if (!(integral < 1e30)) fail_input("{}: the environment image is too bright", image.name);
    map.ref = {0, width, height, alias_bits, float(integral)};
    return map;
}

}  // namespace etendue
