#include "host/bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/html.h"
#include "host/image/atomic_file.h"

namespace etendue {
namespace {

constexpr double targets[] = {0.1, 0.05, 0.02, 0.01, 0.005, 0.001};  // relMSE

std::string shown_seconds(double seconds) {
    return seconds < 9.95 ? fmt::format("{:.2g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string shown_slope(const std::optional<LineFit>& fit) {
    return fit ? fmt::format("{:.2f} ± {:.2f}", fit->slope, fit->slope_error) : "–";
}

std::string shown_bias(const Mean& bias) {
    return std::isfinite(bias.error) ? fmt::format("{:+.2f} ± {:.2f} %", 100 * bias.value, 100 * bias.error)
                                     : fmt::format("{:+.2f} %", 100 * bias.value);
}

std::string shown_time(const std::vector<BenchLevel>& levels, double target) {
    std::vector<CurvePoint> curve;
    for (const BenchLevel& level : levels)
        if (level.seconds > 0) curve.push_back({level.seconds, level.relmse});
    if (curve.empty()) return "–";
    const Crossing crossing = find_crossing(curve, target);
    const char* sign = crossing.kind == Crossing::Kind::before_first ? "<"
                       : crossing.kind == Crossing::Kind::after_last ? ">"
                                                                     : "";
    return fmt::format("{}{}", sign, shown_seconds(crossing.x));
}

std::string scene_section(const std::filesystem::path& folder, const BenchResults& results,
                          const BenchScene& scene) {
    const std::vector<BenchCurve> all = curves(results, scene);
    std::string html = fmt::format(
        "<h2>{}</h2>\n<p>{}, {} × {} pixels, on {}.<br>\nReference: {}; its own "
        "relMSE is {}.</p>\n",
        escaped(scene.name), escaped(scene.file), scene.width, scene.height, escaped(scene.device),
        escaped(scene.reference),
        scene.reference_relmse > 0 ? fmt::format("{:.2g}", scene.reference_relmse) : "taken for 0");
    html += as_html(summary_table(all));
    for (const BenchCurve& curve : all)
        if (curve.left_out > 0)
            html += fmt::format(
                "<p class=\"note\">{}: {} of its numbers of passes are left out: their error "
                "is below the reference's.</p>\n",
                escaped(curve.algorithm), curve.left_out);
    for (const std::string& note : scene.notes)
        html += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
    html += "<div class=\"row\">\n";
    for (const char* axis : {"seconds", "rays"})
        if (const std::string svg = inline_svg(folder / (scene.name + "." + axis + ".svg")); !svg.empty())
            html += "<figure>" + svg + "</figure>\n";
    html += "</div>\n<div class=\"row\">\n";
    std::vector<std::string> names;
    for (const BenchCurve& curve : all) names.push_back(curve.algorithm);
    names.push_back("reference");
    for (const std::string& name : names) {
        const auto path = folder / (scene.name + "." + name + ".png");
        if (!std::filesystem::exists(path)) continue;
        html += fmt::format(
            "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\">"
            "<figcaption>{0}</figcaption></figure>\n",
            escaped(name), base64(read_whole_file(path)));
    }
    return html + "</div>\n";
}

}  // namespace

Table summary_table(const std::vector<BenchCurve>& curves) {
    Table table = {{"algorithm", "passes", "seconds", "relMSE", "bias", "Mrays/s", "slope by passes",
                    "slope by seconds"}};
    for (double target : targets) table[0].push_back(fmt::format("to {:g}", target));
    for (const BenchCurve& curve : curves) {
        std::vector<std::string> row = {curve.algorithm, "–", "–", "–"};
        if (!curve.levels.empty()) {
            const BenchLevel& last = curve.levels.back();
            row = {curve.algorithm, fmt::format("{:.0f}", last.passes), fmt::format("{:.3g}", last.seconds),
                   fmt::format("{:.2g}", last.relmse)};
        }
        row.push_back(shown_bias(curve.bias));
        row.push_back(curve.rays_per_second > 0 ? fmt::format("{:.2f}", 1e-6 * curve.rays_per_second) : "–");
        row.push_back(shown_slope(curve.by_passes));
        row.push_back(shown_slope(curve.by_seconds));
        for (double target : targets) row.push_back(shown_time(curve.levels, target));
        table.push_back(row);
    }
    return table;
}

void write_page(const std::filesystem::path& folder, const BenchResults& results) {
    std::string html = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Error against time</title>
<style>
body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 1500px; padding: 0 1em; color: #222; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .25em .7em; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
.row { display: flex; flex-wrap: wrap; gap: 1em; }
figure { margin: 1em 0; } figure svg { width: 720px; max-width: 100%; height: auto; }
img { min-width: 240px; max-width: 360px; image-rendering: pixelated; } figcaption, .note { color: #666; margin: .3em 0; }
</style></head><body>
<h1>Error against time</h1>
<p>relMSE = mean((I − R)² / (R² + 0.01 mean(R)²)) over pixels and channels, less the reference's own. Every point is a
render of its own with another seed; seconds are of rendering alone, without start, compilation, warm-up and
developing. Slopes are of lines through log relMSE, with their standard errors: −1 for independent samples. “to 0.01”
is the time from which on the error stays below 0.01, interpolated in logarithms. Bias is that of the image's mean,
over all renders; its standard error does not hold the reference's.</p>
)";
    for (const BenchScene& scene : results.scenes) html += scene_section(folder, results, scene);
    html += "</body></html>\n";
    write_atomically(folder / "index.html", std::as_bytes(std::span(html.data(), html.size())));
}

}  // namespace etendue
