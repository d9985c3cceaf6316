// What colour the light of a meter is, and how it renders colours.
#include <fmt/format.h>

#include <cmath>

#include "host/measure/figures.h"
#include "host/spectra/chromaticity.h"
#include "host/spectra/color.h"
#include "host/spectra/color_rendering.h"

namespace etendue {
namespace {

void add_colors(std::vector<Figure>& figures, const Readings& readings, const std::vector<double>& weights) {
    std::vector<Series> xyz(3);
    for (uint32_t k = 0; k < replicates; ++k) {
        const PixelMeans means = replicate_means(readings, k);
        glm::dvec3 sum(0);
        for (size_t i = 0; i < means.size(); ++i) sum += weights[i] * means[i];
        sum = xyz_of_rgb(sum);
        for (int c = 0; c < 3; ++c) xyz[size_t(c)].push_back(sum[c]);
    }
    const auto add = [&](const char* name, const char* unit, auto f) {
        figures.push_back(
            {name, unit,
             function_interval(xyz,
                               [&](const std::vector<double>& m) { return f(glm::dvec3(m[0], m[1], m[2])); }),
             ""});
    };
    add("x", "", [](const glm::dvec3& c) { return chromaticity_xy(c).x; });
    add("y", "", [](const glm::dvec3& c) { return chromaticity_xy(c).y; });
    add("u'", "", [](const glm::dvec3& c) { return chromaticity_uv(c).x; });
    add("v'", "", [](const glm::dvec3& c) { return chromaticity_uv(c).y; });
    const glm::dvec3 mean(mean_of(xyz[0]), mean_of(xyz[1]), mean_of(xyz[2]));
    if (std::abs(correlated_color_temperature(mean).duv) > most_duv) return;
    add("CCT", "K", [](const glm::dvec3& c) { return correlated_color_temperature(c).kelvin; });
    add("Duv", "", [](const glm::dvec3& c) { return correlated_color_temperature(c).duv; });
}

// Indices of colour rendering, of what all pixels together receive.
void add_color_rendering(std::vector<Figure>& figures, const Readings& readings,
                         const std::vector<double>& weights) {
    const Meter& meter = readings.meter;
    if (readings.spectral_bins < least_rendering_bins) return;
    std::vector<Series> bins(readings.spectral_bins, Series(replicates, 0.0));
    for (uint32_t row = 0; row < meter.rows; ++row) {
        // Pixels of a row stand for equal extents.
        const double weight = weights[size_t(row) * meter.columns] * meter.columns;
        for (uint32_t k = 0; k < replicates; ++k) {
            const std::vector<double> spectrum = row_spectrum(readings, row, k);
            for (size_t bin = 0; bin < bins.size(); ++bin) bins[bin][k] += weight * spectrum[bin];
        }
    }
    std::vector<double> centers, means;
    for (size_t bin = 0; bin < bins.size(); ++bin) {
        centers.push_back(first_nm + (double(bin) + 0.5) * (last_nm - first_nm) / double(bins.size()));
        means.push_back(mean_of(bins[bin]));
    }
    const auto rendering = [&](const std::vector<double>& values) {
        return color_rendering(interpolate(centers, values, Outside::hold));
    };
    if (const double off = rendering(means).off_reference; !(off <= most_off_reference)) {
        figures.push_back({"Ra",
                           "",
                           {NAN, NAN, NAN},
                           fmt::format("out of range: {:.4f} from the reference in u, v, above {}", off,
                                       most_off_reference)});
        return;
    }
    const std::vector<Interval> intervals = function_intervals(bins, [&](const auto& m) {
        const ColorRendering r = rendering(m);
        std::vector<double> indices = {r.general};
        indices.insert(indices.end(), r.each.begin(), r.each.end());
        return indices;
    });
    for (size_t i = 0; i < intervals.size(); ++i)
        figures.push_back({i == 0 ? "Ra" : fmt::format("R{}", i), "", intervals[i], ""});
}

}  // namespace

std::vector<Figure> color_figures(const Readings& readings, const std::vector<double>& weights) {
    std::vector<Figure> figures;
    add_colors(figures, readings, weights);
    add_color_rendering(figures, readings, weights);
    return figures;
}

}  // namespace etendue
