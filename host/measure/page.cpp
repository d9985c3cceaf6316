// The page of a measurement.
#include <fmt/format.h>

#include "host/html.h"
#include "host/image/atomic_file.h"
#include "host/measure/report.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

constexpr const char* head =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Measurement</title><style>\n"
    "body{font:15px/1.45 sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem;color:#222}\n"
    "table{border-collapse:collapse;margin:.6rem 0}th,td{padding:.15rem .7rem;border-bottom:1px solid #ddd;"
    "text-align:right}th:first-child,td:first-child,td:last-child,th:last-child{text-align:left}\n"
    "figure{margin:.5rem 0;display:inline-block;vertical-align:top}img,svg{max-width:100%}\n"
    ".note{color:#a33}dt{font-weight:bold}</style></head><body>\n";

std::string shown(const Attribute& attribute) {
    if (const auto* text = std::get_if<std::string>(&attribute)) return *text;
    return fmt::format("{:.10g}", std::get<double>(attribute));
}

// Where the light has gone.
std::string ledger(const Measurement& measurement) {
    const std::vector<BalanceLine> lines = balance_of(measurement);
    if (lines.empty()) return "";
    Table table = {{"light", "lm", "share of the emitted", ""}};
    const double emitted = lines.front().flux;
    for (const BalanceLine& line : lines)
        table.push_back({line.name, fmt::format("{:.6g}", line.flux),
                         emitted > 0 ? fmt::format("{:.4f} %", 100 * line.flux / emitted) : "–", line.text});
    return "<h2>Balance of power</h2>\n" + as_html(table) +
           "<p>Meters take no light: what they read passes on and ends in one of these lines.</p>\n";
}

std::string meter_section(const ReportOptions& options, const Measurement& measurement,
                          const Readings& readings, const std::vector<Figure>& figures,
                          const std::string& name) {
    const Meter& meter = readings.meter;
    std::string html = fmt::format("<h2>{}</h2>\n<p>{} × {} pixels, {}.</p>\n", escaped(meter.name),
                                   meter.columns, meter.rows, meter.unit);
    html += as_html(figure_table(figures));
    if (is_dark(readings))
        html +=
            fmt::format("<p class=\"note\">{}</p>\n", escaped(darkness_text(readings, measurement.power)));
    const fs::path stem = options.folder / name;
    if (const fs::path map = stem.string() + ".map.png"; fs::exists(map))
        html += fmt::format(
            "<figure><img alt=\"{} in false colours\" src=\"data:image/png;base64,{}\"></figure>\n",
            escaped(meter.name), base64(read_whole_file(map)));
    for (const char* plot : {".sections.svg", ".polar.svg"})
        if (const std::string svg = inline_svg(stem.string() + plot); !svg.empty())
            html += "<figure>" + svg + "</figure>\n";
    return html;
}

}  // namespace

std::string page_of(const ReportOptions& options, const Measurement& measurement,
                    const MeterFigures& figures) {
    std::string html = head;
    html += "<h1>Measurement</h1>\n<dl>\n";
    for (const auto& [name, value] : options.attributes)
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(shown(value)));
    html += "</dl>\n<p>Intervals hold the truth with 95 % confidence, by the spread of " +
            fmt::format("{} independent renders. Rays: {}; {}.</p>\n", replicates,
                        algorithm_name(measurement.choice.algorithm), escaped(measurement.choice.reason));
    const std::vector<std::string> names = file_names(measurement);
    for (size_t m = 0; m < names.size(); ++m)
        html += meter_section(options, measurement, measurement.meters[m], figures[m], names[m]);
    return html + ledger(measurement) + "</body></html>\n";
}

}  // namespace etendue
