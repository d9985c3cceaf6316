// The plots of a bench, drawn by gnuplot.
#include <fmt/format.h>

#include "host/bench/report.h"
#include "host/gnuplot.h"

namespace etendue {
namespace {

// Okabe and Ito's palette, which colour-blind readers can tell apart too.
constexpr const char* colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000", "#999999"};

struct Axis {
    const char* name;
    const char* label;
    double BenchLevel::*value;
};
constexpr Axis axes[] = {{"seconds", "seconds of rendering", &BenchLevel::seconds},
                         {"rays", "rays", &BenchLevel::rays}};

std::string plot(const std::filesystem::path& file, const std::string& title, const Axis& axis,
                 const std::vector<BenchCurve>& curves, double reference_relmse) {
    std::string data, lines;
    for (size_t i = 0; i < curves.size(); ++i) {
        std::string rows;
        for (const BenchLevel& level : curves[i].levels)
            if (level.*axis.value > 0) rows += fmt::format("{} {}\n", level.*axis.value, level.relmse);
        if (rows.empty()) continue;
        data += fmt::format("$curve{} << END\n{}END\n", i, rows);
        lines += fmt::format(
            "{}$curve{} with linespoints linewidth 2 pointtype 7 pointsize 0.5 linecolor "
            "rgb '{}' title {}",
            lines.empty() ? "" : ", ", i, colors[i % std::size(colors)],
            quoted_for_gnuplot(curves[i].algorithm));
    }
    if (lines.empty()) return "";
    if (reference_relmse > 0)
        lines += fmt::format(
            ", {} with lines dashtype 2 linecolor rgb '#888888' title 'own error of the reference'",
            reference_relmse);
    return fmt::format(
        "{}set output {}\nset title {}\nset xlabel '{}'\nset ylabel 'relMSE'\nplot {}\nunset output\n", data,
        quoted_for_gnuplot(file.string()), quoted_for_gnuplot(title), axis.label, lines);
}

}  // namespace

std::string draw_plots(const std::filesystem::path& folder, const BenchResults& results) {
    std::string script =
        "set terminal svg size 720,480 noenhanced font 'sans-serif,13' background rgb '#ffffff'\n"
        "set logscale xy\nset format '%g'\nset grid linecolor rgb '#dddddd'\nset key bottom left Left "
        "reverse opaque\n";
    for (const BenchScene& scene : results.scenes) {
        const std::vector<BenchCurve> all = curves(results, scene);
        for (const Axis& axis : axes) {
            const auto file = folder / (scene.name + "." + axis.name + ".svg");
            std::filesystem::remove(file);
            script += plot(file, scene.name, axis, all, scene.reference_relmse);
        }
    }
    return run_gnuplot(script);
}

}  // namespace etendue
