#include "host/measure/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/error.h"
#include "host/measure/glare.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

// A weight a pixel, of sum 1, by the extents.
std::vector<double> weights_of(const Meter& meter) {
    std::vector<double> weights(meter.pixels(), 1.0 / double(meter.pixels()));
    if (!meter.has_extent) return weights;
    double sum = 0;
    for (const PixelPlace& place : meter.places) sum += place.extent;
    for (size_t i = 0; i < weights.size(); ++i) weights[i] = meter.places[i].extent / sum;
    return weights;
}

double extent_of(const Meter& meter) {
    double sum = 0;
    for (const PixelPlace& place : meter.places) sum += place.extent;
    return sum;
}

Series weighted(const std::vector<std::vector<double>>& values, const std::vector<double>& weights) {
    Series series;
    for (const auto& replicate : values)
        series.push_back(std::inner_product(replicate.begin(), replicate.end(), weights.begin(), 0.0));
    return series;
}

size_t extreme_pixel(const std::vector<std::vector<double>>& values, double sign) {
    size_t best = 0;
    double most = -INFINITY;
    for (size_t i = 0; i < values[0].size(); ++i) {
        double sum = 0;
        for (const auto& replicate : values) sum += sign * replicate[i];
        if (sum > most) most = sum, best = i;
    }
    return best;
}

// The extreme of many noisy values, by `sign` the greatest or (-1) the least.
struct Extreme {
    Series beyond;  // where all replicates together have it: rather too far out
    Series within;  // each replicate where the others have it: rather not far enough
};

Extreme extreme(const std::vector<std::vector<double>>& values, double sign) {
    std::vector<double> sums(values[0].size(), 0.0);
    for (const auto& replicate : values)
        for (size_t i = 0; i < sums.size(); ++i) sums[i] += replicate[i];
    const size_t of_all = extreme_pixel(values, sign);
    Extreme result;
    for (const auto& replicate : values) {
        size_t best = 0;
        for (size_t i = 1; i < sums.size(); ++i)
            if (sign * (sums[i] - replicate[i]) > sign * (sums[best] - replicate[best])) best = i;
        result.within.push_back(replicate[best]);
        result.beyond.push_back(replicate[of_all]);
    }
    return result;
}

// What holds whatever either does.
Interval hull(const Interval& a, const Interval& b) {
    return {0.5 * (a.value + b.value), std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval extreme_interval(const Extreme& e) { return hull(mean_interval(e.beyond), mean_interval(e.within)); }

std::string place_text(const Meter& meter, size_t pixel) {
    const uint32_t column = uint32_t(pixel % meter.columns), row = uint32_t(pixel / meter.columns);
    if (meter.is_far)
        return fmt::format("C {:.5g}°, γ {:.5g}°", c_angle(meter, column), gamma_angle(meter, row));
    const glm::vec3 p = meter.places[pixel].position;
    if (meter.triangles > 0)
        return fmt::format("triangle {}: {:.4g}, {:.4g}, {:.4g} m", pixel, p.x, p.y, p.z);
    return fmt::format("column {}, row {}: {:.4g}, {:.4g}, {:.4g} m", column, row, p.x, p.y, p.z);
}

// Bilinear between the pixels' middles.
double at_point(const std::vector<double>& values, const Meter& meter, const MeterPoint& point) {
    const glm::dvec2 size(meter.columns, meter.rows);
    const glm::dvec2 at = glm::clamp(point * size - 0.5, glm::dvec2(0), size - 1.0);
    const glm::uvec2 lo = glm::uvec2(at), hi = glm::min(lo + 1u, glm::uvec2(size) - 1u);
    const glm::dvec2 t = at - glm::dvec2(lo);
    const auto pixel = [&](uint32_t x, uint32_t y) { return values[size_t(y) * meter.columns + x]; };
    return glm::mix(glm::mix(pixel(lo.x, lo.y), pixel(hi.x, lo.y), t.x),
                    glm::mix(pixel(lo.x, hi.y), pixel(hi.x, hi.y), t.x), t.y);
}

Interval ratio(const Series& a, const Series& b) {
    return function_interval({a, b}, [](const auto& m) { return m[1] != 0 ? m[0] / m[1] : NAN; });
}
Interval ratio(const Extreme& a, const Extreme& b) {
    return hull(ratio(a.beyond, b.beyond), ratio(a.within, b.within));
}
Interval ratio(const Extreme& a, const Series& b) { return hull(ratio(a.beyond, b), ratio(a.within, b)); }

void add_points(std::vector<Figure>& figures, const Meter& meter,
                const std::vector<std::vector<double>>& values, const std::vector<MeterPoint>& points) {
    std::vector<std::vector<double>> at_points;
    for (const auto& replicate : values) {
        auto& row = at_points.emplace_back();
        for (const MeterPoint& point : points) row.push_back(at_point(replicate, meter, point));
    }
    const Extreme least = extreme(at_points, -1), greatest = extreme(at_points, 1);
    const Series mean = weighted(at_points, std::vector<double>(points.size(), 1.0 / double(points.size())));
    for (size_t i = 0; i < points.size(); ++i) {
        Series series;
        for (const auto& row : at_points) series.push_back(row[i]);
        figures.push_back({fmt::format("point {} ({:.4g}, {:.4g})", i + 1, points[i].x, points[i].y),
                           meter.unit, mean_interval(series), ""});
    }
    figures.push_back({fmt::format("min / max of {} points", points.size()), "", ratio(least, greatest), ""});
    figures.push_back({fmt::format("min / mean of {} points", points.size()), "", ratio(least, mean), ""});
}

// `mean`: of all light.
void add_layer(std::vector<Figure>& figures, const Readings& readings, const LayerReadings& layer,
               const Series& mean) {
    const Meter& meter = readings.meter;
    const Series part = weighted(luminous_values(of_layer(readings, layer)), weights_of(meter));
    if (meter.has_extent) {
        Series flux;
        for (double x : part) flux.push_back(extent_of(meter) * x);
        figures.push_back({"flux of " + layer.name, "lm", mean_interval(flux), ""});
    }
    figures.push_back({"mean of " + layer.name, meter.unit, mean_interval(part), ""});
    figures.push_back({"share of " + layer.name, "", ratio(part, mean), ""});
}

}  // namespace

double mean_of(const Series& series) {
    return std::accumulate(series.begin(), series.end(), 0.0) / double(series.size());
}

std::vector<std::vector<double>> luminous_values(const Readings& readings) {
    const Meter& meter = readings.meter;
    std::vector<std::vector<double>> values(replicates);
    for (uint32_t k = 0; k < replicates; ++k) {
        for (const glm::dvec3& rgb : replicate_means(readings, k)) values[k].push_back(luminance(rgb));
        if (!meter.is_far) continue;
        for (size_t first : {size_t(0), meter.pixels() - meter.columns}) {
            const auto begin = values[k].begin() + std::ptrdiff_t(first), end = begin + meter.columns;
            std::fill(begin, end, std::accumulate(begin, end, 0.0) / meter.columns);
        }
    }
    return values;
}

double student_factor(size_t samples) {
    // Of 1 to 20 degrees of freedom; beyond, Cornish & Fisher's expansion (Abramowitz & Stegun 26.7.5).
    static constexpr double table[] = {12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462,
                                       2.30600, 2.26216, 2.22814, 2.20099, 2.17881, 2.16037, 2.14479,
                                       2.13145, 2.11991, 2.10982, 2.10092, 2.09302, 2.08596};
    if (samples < 2) return INFINITY;
    if (samples - 2 < std::size(table)) return table[samples - 2];
    const double x = 1.959964, n = double(samples - 1);
    return x + (x * x * x + x) / (4 * n) + (5 * std::pow(x, 5) + 16 * x * x * x + 3 * x) / (96 * n * n);
}

Interval mean_interval(const Series& series) {
    const double mean = mean_of(series), n = double(series.size());
    double squares = 0;
    for (double x : series) squares += (x - mean) * (x - mean);
    const double half = student_factor(series.size()) * std::sqrt(squares / (n * (n - 1)));
    return {mean, mean - half, mean + half};
}

std::vector<Interval> function_intervals(
    const std::vector<Series>& series,
    const std::function<std::vector<double>(const std::vector<double>&)>& f) {
    const size_t n = series[0].size();
    std::vector<double> means;
    for (const Series& s : series) means.push_back(mean_of(s));
    std::vector<Series> left_out(n);
    for (size_t k = 0; k < n; ++k) {
        std::vector<double> others;
        for (size_t i = 0; i < series.size(); ++i)
            others.push_back((double(n) * means[i] - series[i][k]) / double(n - 1));
        left_out[k] = f(others);
    }
    std::vector<Interval> intervals;
    for (const double whole : f(means)) {
        Series values;
        for (const Series& s : left_out) values.push_back(s[intervals.size()]);
        const double mean = mean_of(values);
        double squares = 0;
        for (double x : values) squares += (x - mean) * (x - mean);
        const double half = student_factor(n) * std::sqrt(squares * double(n - 1) / double(n));
        const double unbiased = double(n) * whole - double(n - 1) * mean;
        intervals.push_back({unbiased, unbiased - half, unbiased + half});
    }
    return intervals;
}

Interval function_interval(const std::vector<Series>& series,
                           const std::function<double(const std::vector<double>&)>& f) {
    return function_intervals(series, [&](const auto& m) { return std::vector<double>{f(m)}; })[0];
}

std::vector<MeterPoint> standard_points(uint32_t count) {
    std::vector<MeterPoint> points;
    const double sixths[] = {1.0 / 6, 0.5, 5.0 / 6};
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            if (count != 5 || x % 2 == y % 2) points.push_back({sixths[x], sixths[y]});
    if (count == 13)
        for (double y : {0.1, 0.9})
            for (double x : {0.1, 0.9}) points.push_back({x, y});
    return points;
}

std::vector<Figure> figures_of(const Readings& readings, const std::vector<MeterPoint>& points,
                               double glare_from) {
    const Meter& meter = readings.meter;
    if (has_parts(readings)) {
        std::vector<Figure> all;
        for (const ReadingsPart& part : parts_of(readings))
            for (Figure& figure : figures_of(part.readings, {})) {
                figure.name = part.name + ": " + figure.name;
                all.push_back(std::move(figure));
            }
        return all;
    }
    const auto values = luminous_values(readings);
    const std::vector<double> weights = weights_of(meter);
    const Series mean = weighted(values, weights);
    const Extreme least = extreme(values, -1), greatest = extreme(values, 1);
    std::vector<Figure> figures;
    if (meter.has_extent) {
        const double extent = extent_of(meter);
        Series flux;
        for (double x : mean) flux.push_back(extent * x);
        figures.push_back({"flux", "lm", mean_interval(flux), ""});
    }
    figures.push_back({"mean", meter.unit, mean_interval(mean), ""});
    if (meter.pixels() > 1) {
        figures.push_back(
            {"minimum", meter.unit, extreme_interval(least), place_text(meter, extreme_pixel(values, -1))});
        figures.push_back(
            {"maximum", meter.unit, extreme_interval(greatest), place_text(meter, extreme_pixel(values, 1))});
    }
    if (is_dark(readings)) return figures;
    if (meter.pixels() > 1 && !meter.is_far) {
        figures.push_back({"U0 = minimum / mean", "", ratio(least, mean), ""});
        figures.push_back({"Ud = minimum / maximum", "", ratio(least, greatest), ""});
    }
    if (!points.empty() && !meter.is_far && meter.pixels() > 1) add_points(figures, meter, values, points);
    std::ranges::move(glare_figures(meter, values, glare_from), std::back_inserter(figures));
    std::ranges::move(color_figures(readings, weights), std::back_inserter(figures));
    for (const LayerReadings& layer : readings.layers) add_layer(figures, readings, layer, mean);
    return figures;
}

std::optional<double> received_flux(const Readings& readings) {
    const Meter& meter = readings.meter;
    if (!meter.has_extent || has_parts(readings)) return {};
    return extent_of(meter) * mean_of(weighted(luminous_values(readings), weights_of(meter)));
}

double relative_error_of_mean(const Readings& readings) {
    const Interval mean = mean_interval(weighted(luminous_values(readings), weights_of(readings.meter)));
    return mean.value > 0 ? 0.5 * (mean.high - mean.low) / mean.value : INFINITY;
}

double relative_error_of_worst(const Readings& readings) {
    const auto values = luminous_values(readings);
    const double mean = mean_of(weighted(values, weights_of(readings.meter)));
    if (!(mean > 0)) return INFINITY;
    double worst = 0;
    for (size_t i = 0; i < values[0].size(); ++i) {
        Series series;
        for (const auto& replicate : values) series.push_back(replicate[i]);
        const Interval pixel = mean_interval(series);
        worst = std::max(worst, 0.5 * (pixel.high - pixel.low) / std::max(pixel.value, 0.01 * mean));
    }
    return worst;
}

bool is_dark(const Readings& readings) {
    return std::all_of(readings.sums.begin(), readings.sums.end(),
                       [](const ExactSum& sum) { return value(sum) == glm::dvec3(0); });
}

std::optional<double> missed_flux(const Readings& readings, double power) {
    const uint64_t paths = readings.forward_paths + readings.probing_paths;
    if (paths == 0 || !is_dark(readings)) return {};
    return 3 * power / double(paths);
}

std::string darkness_text(const Readings& readings, double power) {
    const auto missed = missed_flux(readings, power);
    return missed ? fmt::format("no light has arrived: with 95 % confidence its flux is below {:.3g} lm",
                                *missed)
                  : std::string(
                        "no light has arrived by backward rays; how much they may miss they do not tell");
}

}  // namespace etendue
