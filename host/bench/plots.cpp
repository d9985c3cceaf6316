// The plots of a bench, drawn by gnuplot.
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

#include "host/bench/report.h"

namespace etendue {
namespace {

// Okabe and Ito's palette, which colour-blind readers can tell apart too.
constexpr const char* colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000", "#999999"};

// gnuplot's text in single quotes; a quote is doubled.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (char c : text) result += c == '\'' ? "''" : std::string(1, c);
    return result + "'";
}

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
            lines.empty() ? "" : ", ", i, colors[i % std::size(colors)], quoted(curves[i].algorithm));
    }
    if (lines.empty()) return "";
    if (reference_relmse > 0)
        lines += fmt::format(
            ", {} with lines dashtype 2 linecolor rgb '#888888' title 'own error of the reference'",
            reference_relmse);
    return fmt::format(
        "{}set output {}\nset title {}\nset xlabel '{}'\nset ylabel 'relMSE'\nplot {}\nunset output\n", data,
        quoted(file.string()), quoted(title), axis.label, lines);
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
    if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
        return "no plots: gnuplot is not installed (on Debian: gnuplot-nox)";
    const auto before = signal(SIGPIPE, SIG_IGN);  // where gnuplot ends early
    std::FILE* gnuplot = popen("gnuplot 2>/dev/null", "w");
    const bool sent = gnuplot && std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
    const int status = gnuplot ? pclose(gnuplot) : -1;
    signal(SIGPIPE, before);
    const bool drawn = sent && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return drawn ? "" : "no plots: gnuplot failed";
}

}  // namespace etendue
