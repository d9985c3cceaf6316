// The figures that are told of a meter, each with an interval that holds the truth with 95 % confidence.
//
// A figure is a function of means over pixels, each known from every replicate of the render
// (host/measure/readings.h): a mean's interval is Student's; that of a ratio or of a colour is the
// jackknife's, which leaves each replicate out in turn (Efron & Stein 1981, "The Jackknife Estimate of
// Variance"). The least of many noisy pixels is too low, and what the others' least pixel has in each
// replicate too high where pixels are nearly equal: the interval of a minimum or maximum reaches around both,
// and holds the truth in 95 % of cases where one pixel stands out, else in more.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/readings.h"

namespace etendue {

struct Interval {
    double value = 0, low = 0, high = 0;
};

// One value of each replicate, of something whose mean is wanted.
using Series = std::vector<double>;
double mean_of(const Series& series);
Interval mean_interval(const Series& series);
// Of f(means of the series), by the jackknife. All series are as long.
Interval function_interval(const std::vector<Series>& series,
                           const std::function<double(const std::vector<double>&)>& f);
// The same of each of several values of f.
std::vector<Interval> function_intervals(
    const std::vector<Series>& series,
    const std::function<std::vector<double>(const std::vector<double>&)>& f);
// Student's t for 95 % of two sides.
double student_factor(size_t samples);

// Luminous values of the pixels, replicate after replicate. Of a meter far away all pixels of the first and
// the last row look the same way: each is their mean.
std::vector<std::vector<double>> luminous_values(const Readings& readings);

struct Figure {
    std::string name;  // "mean", "U0 = min / mean"
    std::string unit;  // empty = a number
    Interval interval;
    std::string where;  // of a minimum or maximum: which pixel; of what has no value: why; else empty
};

// A point of a meter, in parts of its width and height from the upper left corner.
using MeterPoint = glm::dvec2;
// 5, 9 or 13 points as displays are judged by (IEC 62977 and makers' data sheets): 9 at 1/6, 1/2 and 5/6 of
// each side; 5: their corners and middle; 13: the 9, and four at 1/10 and 9/10.
std::vector<MeterPoint> standard_points(uint32_t count);

// Luminance, cd/m², above which something glares: lamps do, lit walls don't.
constexpr double usual_glare_from = 500;

// Bins of a spectrum below which they are too wide for colour rendering: 10 nm.
constexpr uint32_t least_rendering_bins = 47;

// Of what all pixels together receive, weighted by `weights`, whose sum is 1: chromaticities, and with bins
// colour rendering.
std::vector<Figure> color_figures(const Readings& readings, const std::vector<double>& weights);

// `points`: for uniformity; empty = none. `glare_from`: see host/measure/glare.h. Layers: the mean of each,
// its flux and its share of all light.
std::vector<Figure> figures_of(const Readings& readings, const std::vector<MeterPoint>& points,
                               double glare_from = usual_glare_from);

// lm that have come to a meter, the figure `flux`; nothing where its pixels stand for no area or solid angle,
// or it has parts.
std::optional<double> received_flux(const Readings& readings);

// Half the interval of a meter's mean, by its value: what --error asks. Infinite where it is 0.
double relative_error_of_mean(const Readings& readings);
// The same of the worst pixel; pixels below a hundredth of the mean are judged by that.
double relative_error_of_worst(const Readings& readings);

// Where nothing has arrived: the flux, lm, that may have been missed all the same, with 95 % confidence: of n
// paths from the lights none came, so at most 3 / n of their flux does (rule of three; Hanley & Lippman-Hand
// 1983). Nothing where light has arrived, or no paths started at lights.
std::optional<double> missed_flux(const Readings& readings, double power);
std::string darkness_text(const Readings& readings, double power);  // a sentence that says both
bool is_dark(const Readings& readings);

}  // namespace etendue
