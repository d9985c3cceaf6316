// Maps, sections and polar diagrams of what meters read, as scripts for gnuplot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/gnuplot.h"
#include "host/measure/report.h"

namespace etendue {
namespace {

// Luminous means and half their intervals, pixel by pixel.
struct Map {
    std::vector<double> values, halves;
    double greatest = 0;
};

Map map_of(const Readings& readings) {
    Map map;
    const size_t pixels = readings.meter.pixels();
    const auto replicate_values = luminous_values(readings);
    for (size_t i = 0; i < pixels; ++i) {
        Series series;
        for (const auto& values : replicate_values) series.push_back(values[i]);
        const Interval pixel = mean_interval(series);
        map.values.push_back(pixel.value), map.halves.push_back(0.5 * (pixel.high - pixel.low));
        map.greatest = std::max(map.greatest, pixel.value);
    }
    return map;
}

// Where pixels stand along a side: degrees of directions, else metres from the corner, or numbers of pixels.
struct Axes {
    std::string x_label, y_label;
    double x_first, x_step, y_first, y_step;
};

Axes axes_of(const Meter& meter) {
    if (meter.is_far)
        return {"C, degrees", "γ, degrees", 0, 360.0 / meter.columns, 0, 180.0 / (meter.rows - 1.0)};
    if (!meter.has_extent) return {"column", "row", 0, 1, 0, 1};
    const auto step = [&](size_t to, uint32_t count) {
        return count > 1 ? double(glm::distance(meter.places[0].position, meter.places[to].position)) : 1.0;
    };
    const double x = step(1, meter.columns), y = step(meter.columns, meter.rows);
    return {"x from the left, m", "y from the top, m", 0.5 * x, x, 0.5 * y, y};
}

// Dark to light through distinct hues, rising evenly in lightness: after Smith & van der Walt's viridis
// (2015).
constexpr const char* palette =
    "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', 6 "
    "'#5ec962', "
    "7 '#addc30', 8 '#fde725')\n";

std::string draw_map(const Readings& readings, const Map& map, const Axes& axes,
                     const std::filesystem::path& file) {
    const Meter& meter = readings.meter;
    std::string data = "$map << END\n";
    for (uint32_t row = 0; row < meter.rows; ++row) {
        for (uint32_t column = 0; column < meter.columns; ++column)
            data += fmt::format("{:.6g} {:.6g} {:.6g}\n", axes.x_first + column * axes.x_step,
                                axes.y_first + row * axes.y_step,
                                map.values[size_t(row) * meter.columns + column]);
        data += "\n";
    }
    const double width = meter.columns * axes.x_step, height = meter.rows * axes.y_step;
    const std::string shape =
        meter.is_far ? "set size noratio\n" : fmt::format("set size ratio {:.6g}\n", height / width);
    return data +
           fmt::format(
               "END\nset terminal pngcairo size 900,640 font 'sans-serif,12'\n{}{}"
               "set xlabel '{}'\nset ylabel '{}'\nset cblabel '{}'\n"
               "set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\nset cbrange [0:{:.6g}]\n"
               "set contour base\nunset surface\nset cntrparam levels auto 8\nset table $isolines\n"
               "splot $map using 1:2:3 with lines\nunset table\nset surface\nunset contour\n"
               "set output {}\nset title {}\n"
               "plot $map using 1:2:3 with image notitle, $isolines using 1:2 with lines linecolor rgb "
               "'white' "
               "notitle, $isolines using 1:2:3 every 60::20 with labels textcolor rgb 'white' notitle\n"
               "unset output\nunset cblabel\n",
               palette, shape, axes.x_label, axes.y_label, meter.unit, axes.x_first - 0.5 * axes.x_step,
               axes.x_first - 0.5 * axes.x_step + width, axes.y_first - 0.5 * axes.y_step + height,
               axes.y_first - 0.5 * axes.y_step, map.greatest, quoted_for_gnuplot(file.string()),
               quoted_for_gnuplot(fmt::format("{}, {}", meter.name, meter.unit)));
}

std::string section_data(const Map& map, const char* name, size_t first, size_t stride, size_t count,
                         double at, double step) {
    std::string data = fmt::format("${} << END\n", name);
    for (size_t i = 0; i < count; ++i) {
        const double value = map.values[first + i * stride], half = map.halves[first + i * stride];
        data += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", at + double(i) * step, value, value - half,
                            value + half);
    }
    return data + "END\n";
}

constexpr const char* svg =
    "set terminal svg size 720,420 noenhanced font 'sans-serif,13' background rgb '#ffffff'\n";

// Along the middle row and column.
std::string draw_sections(const Meter& meter, const Map& map, const Axes& axes,
                          const std::filesystem::path& file) {
    const size_t row = meter.rows / 2, column = meter.columns / 2;
    const auto curve = [](const char* data, const char* color, const std::string& title) {
        return fmt::format(
            "${0} using 1:3:4 with filledcurves fillcolor rgb '{1}' fillstyle transparent solid 0.3 "
            "notitle, ${0} using 1:2 with lines linewidth 2 linecolor rgb '{1}' title '{2}'",
            data, color, title);
    };
    return section_data(map, "along", row * meter.columns, 1, meter.columns, axes.x_first, axes.x_step) +
           section_data(map, "across", column, meter.columns, meter.rows, axes.y_first, axes.y_step) +
           fmt::format(
               "{}set size noratio\nset key bottom center\nset autoscale\nset yrange [0:*]\nset xlabel '{}; "
               "{}'\nset ylabel '{}'\n"
               "set output {}\nset title {}\nplot {}, {}\nunset output\n",
               svg, axes.x_label, axes.y_label, meter.unit, quoted_for_gnuplot(file.string()),
               quoted_for_gnuplot(meter.name + ": sections through the middle, 95 % intervals"),
               curve("along", "#0072b2", "along x"), curve("across", "#d55e00", "along y"));
}

// A plane of gamma from -180 to 180 degrees: C on the right, C + 180 degrees on the left.
std::string plane_data(const Meter& meter, const Map& map, const char* name, uint32_t column) {
    std::string data = fmt::format("${} << END\n", name);
    const uint32_t opposite = (column + meter.columns / 2) % meter.columns;
    const auto value = [&](uint32_t row, uint32_t c) { return map.values[size_t(row) * meter.columns + c]; };
    for (uint32_t row = meter.rows; row-- > 1;)
        data += fmt::format("{:.6g} {:.6g}\n", -gamma_angle(meter, row), value(row, opposite));
    for (uint32_t row = 0; row < meter.rows; ++row)
        data += fmt::format("{:.6g} {:.6g}\n", gamma_angle(meter, row), value(row, column));
    return data + "END\n";
}

std::string draw_polar(const Meter& meter, const Map& map, const std::filesystem::path& file) {
    const size_t peak = size_t(std::max_element(map.values.begin(), map.values.end()) - map.values.begin());
    const uint32_t c90 = (meter.columns + 2) / 4 % meter.columns, c_peak = uint32_t(peak % meter.columns);
    const auto title = [&](uint32_t column) {
        return fmt::format("C{:.4g} – C{:.4g}", c_angle(meter, column),
                           c_angle(meter, (column + meter.columns / 2) % meter.columns));
    };
    std::string script = plane_data(meter, map, "c0", 0) + plane_data(meter, map, "c90", c90) +
                         plane_data(meter, map, "cpeak", c_peak);
    script += fmt::format(
        "set terminal svg size 560,560 noenhanced font 'sans-serif,13' background rgb '#ffffff'\nset "
        "polar\nset angles "
        "degrees\nset theta bottom counterclockwise\nset size square\nunset border\nunset xtics\nunset "
        "ytics\nunset "
        "xlabel\nunset ylabel\nset grid polar 30\nset rrange [0:{:.6g}]\nset rtics\nset key outside bottom "
        "center horizontal\nset ttics "
        "-180,30,180\nset output "
        "{}\nset title {}\nplot $c0 with lines linewidth 2 linecolor rgb '#0072b2' title '{}', $c90 with "
        "lines linewidth "
        "2 linecolor rgb '#d55e00' title '{}', $cpeak with lines dashtype 2 linecolor rgb '#009e73' title "
        "'{} (peak)'\n"
        "unset output\nset key default\nunset polar\nunset ttics\nunset rtics\nset border\nset xtics\nset "
        "ytics\nset grid "
        "nopolar\n",
        1.05 * map.greatest, quoted_for_gnuplot(file.string()), quoted_for_gnuplot(meter.name + ", cd"),
        title(0), title(c90), title(c_peak));
    return script;
}

}  // namespace

std::string plots_of(const Readings& readings, const std::filesystem::path& stem) {
    const Meter& meter = readings.meter;
    if (meter.pixels() < 2) return "";
    const Map map = map_of(readings);
    const Axes axes = axes_of(meter);
    std::string script;
    if (meter.columns > 1 && meter.rows > 1)
        script += draw_map(readings, map, axes, stem.string() + ".map.png");
    if (meter.is_far) return script + draw_polar(meter, map, stem.string() + ".polar.svg");
    return script + draw_sections(meter, map, axes, stem.string() + ".sections.svg");
}

}  // namespace etendue
