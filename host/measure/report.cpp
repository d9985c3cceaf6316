#include "host/measure/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/error.h"
#include "host/gnuplot.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/measure/ray_export.h"
#include "host/photometry/ies_file.h"
#include "host/photometry/ldt_file.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

// As many digits as the interval leaves, and one more.
std::string shown(double x, double half) {
    if (!std::isfinite(x)) return "–";
    if (!(half > 0) || !std::isfinite(half)) return fmt::format("{:.6g}", x);
    const int digits = int(std::ceil(std::log10(std::max(std::abs(x), half) / half))) + 2;
    return fmt::format("{:.{}g}", x, std::clamp(digits, 2, 9));
}

// Of errors: channels' errors are taken as if they had one cause, so it is at most as large, and in white
// light equal.
double luminance_at(const Image& image, const std::string& layer, size_t pixel) {
    const auto at = [&](const char* channel) {
        return double(plane(image, size_t(find_channel(image, layer + channel)))[pixel]);
    };
    return luminance({at("R"), at("G"), at("B")});
}

std::string pixel_table(const Readings& readings, const Image& image) {
    const Meter& meter = readings.meter;
    std::string text = meter.is_far ? "C_deg,gamma_deg,solid_angle_sr" : "column,row,x_m,y_m,z_m,area_m2";
    text += fmt::format(",value_{0},standard_error_{0}\n", meter.unit == "cd/m²" ? "cd_m2" : meter.unit);
    for (size_t i = 0; i < meter.pixels(); ++i) {
        const uint32_t column = uint32_t(i % meter.columns), row = uint32_t(i / meter.columns);
        const PixelPlace& place = meter.places[i];
        if (meter.is_far)
            text += fmt::format("{:.6g},{:.6g},{:.6g}", c_angle(meter, column), gamma_angle(meter, row),
                                place.extent);
        else
            text +=
                fmt::format("{},{},{:.6g},{:.6g},{:.6g},{}", column, row, place.position.x, place.position.y,
                            place.position.z, meter.has_extent ? fmt::format("{:.6g}", place.extent) : "");
        text += fmt::format(",{:.7g},{:.3g}\n", luminance_at(image, "", i), luminance_at(image, "error.", i));
    }
    return text;
}

// A row a triangle, with what each part reads there.
std::string triangle_table(const Readings& readings) {
    std::string text = "triangle,x_m,y_m,z_m,area_m2";
    for (const char* name : {"front_illuminance", "back_illuminance", "front_exitance", "back_exitance"})
        text += fmt::format(",{0}_lx,standard_error_{0}_lx", name);
    std::vector<Image> images;
    for (const ReadingsPart& part : parts_of(readings)) images.push_back(to_image(part.readings));
    for (uint32_t t = 0; t < readings.meter.triangles; ++t) {
        const PixelPlace& place = readings.meter.places[t];
        text += fmt::format("\n{},{:.6g},{:.6g},{:.6g},{:.6g}", t, place.position.x, place.position.y,
                            place.position.z, place.extent);
        for (const Image& image : images)
            text +=
                fmt::format(",{:.7g},{:.3g}", luminance_at(image, "", t), luminance_at(image, "error.", t));
    }
    return text + "\n";
}

Table table_of_all(const Measurement& measurement, const MeterFigures& figures) {
    Table table = {{"meter", "figure", "unit", "value", "low_95", "high_95", "where"}};
    for (size_t m = 0; m < figures.size(); ++m) {
        const Readings& readings = measurement.meters[m];
        for (const Figure& f : figures[m])
            table.push_back({readings.meter.name, f.name, f.unit, fmt::format("{:.8g}", f.interval.value),
                             fmt::format("{:.8g}", f.interval.low), fmt::format("{:.8g}", f.interval.high),
                             f.where});
        if (const auto missed = missed_flux(readings, measurement.power))
            table.push_back({readings.meter.name, "flux, upper bound", "lm", "0", "0",
                             fmt::format("{:.8g}", *missed), "no light has arrived"});
    }
    return table;
}

}  // namespace

MeterFigures all_figures(const ReportOptions& options, const Measurement& measurement) {
    MeterFigures figures;
    for (const Readings& readings : measurement.meters)
        figures.push_back(figures_of(readings, options.points, options.glare_from));
    return figures;
}

Table figure_table(const std::vector<Figure>& figures) {
    Table table = {{"figure", "value", "± 95 %", "unit", "where"}};
    for (const Figure& f : figures) {
        const double half = 0.5 * (f.interval.high - f.interval.low);
        table.push_back({f.name, shown(f.interval.value, half),
                         std::isfinite(half) ? fmt::format("{:.2g}", half) : "–", f.unit, f.where});
    }
    return table;
}

double relative_error(const Measurement& measurement, bool worst) {
    double error = 0;
    for (const Readings& readings : measurement.meters)
        if (!is_dark(readings))
            error =
                std::max(error, worst ? relative_error_of_worst(readings) : relative_error_of_mean(readings));
    return error;
}

IntensityDistribution intensity_distribution(const Readings& readings) {
    const Meter& meter = readings.meter;
    const auto values = luminous_values(readings);
    IntensityDistribution d;
    for (uint32_t row = 0; row < meter.rows; ++row) d.angles.push_back(gamma_angle(meter, row));
    for (uint32_t column = 0; column <= meter.columns; ++column) {
        d.planes.push_back(c_angle(meter, column));
        for (uint32_t row = 0; row < meter.rows; ++row) {
            double sum = 0;
            for (const auto& replicate : values)
                sum += replicate[size_t(row) * meter.columns + column % meter.columns];
            d.candela.push_back(sum / replicates);
        }
    }
    return d;
}

std::vector<std::string> file_names(const Measurement& measurement) {
    std::vector<std::string> names;
    for (const Readings& readings : measurement.meters) names.push_back(readings.meter.name);
    return file_stems(names);
}

std::vector<std::string> write_report(const ReportOptions& options, const Measurement& measurement,
                                      const MeterFigures& figures, Outputs& outputs) {
    std::vector<std::string> notes;
    const std::vector<std::string> names = file_names(measurement);
    outputs.write([&] {
        write_atomically(options.folder / "figures.csv", as_csv(table_of_all(measurement, figures)));
    });
    if (const auto lines = balance_of(measurement); !lines.empty()) {
        Table table = {{"light", "lm", "meaning"}};
        for (const BalanceLine& line : lines)
            table.push_back({line.name, fmt::format("{:.9g}", line.flux), line.text});
        outputs.write([&] { write_atomically(options.folder / "balance.csv", as_csv(table)); });
    } else {
        fs::remove(options.folder / "balance.csv");  // of an earlier report
    }
    std::string script;
    for (size_t m = 0; m < names.size(); ++m) {
        const Readings& readings = measurement.meters[m];
        const fs::path stem = options.folder / names[m];
        Image image = to_image(readings);
        image.attributes.insert(options.attributes.begin(), options.attributes.end());
        image.attributes["rays"] = double(all_rays(measurement.counters));
        image.attributes["algorithm"] = std::string(algorithm_name(measurement.choice.algorithm));
        outputs.write([&] { write_exr(stem.string() + ".exr", image); });
        const std::string table =
            has_parts(readings) ? triangle_table(readings) : pixel_table(readings, image);
        outputs.write([&] { write_atomically(stem.string() + ".csv", table); });
        if (readings.meter.is_far) {
            const IntensityDistribution d = intensity_distribution(readings);
            const PhotometricLabels labels{"", readings.meter.name, "", "etendue " ETENDUE_VERSION, ""};
            outputs.write([&] { write_ies(stem.string() + ".ies", d, labels); });
            outputs.write([&] { write_ldt(stem.string() + ".ldt", d, labels); });
        }
        if (const auto rays = recorded_rays(readings))
            outputs.write([&] { write_tm25(stem.string() + ".tm25ray", *rays); });
        else if (readings.rays.most > 0)
            notes.push_back(
                fmt::format("{}: no rays have been recorded: forward rays alone are", readings.meter.name));
        for (const char* plot : {".map.png", ".sections.svg", ".polar.svg"}) fs::remove(stem.string() + plot);
        if (!is_dark(readings) && !has_parts(readings)) script += plots_of(readings, stem);
    }
    if (!script.empty())
        if (const std::string failure = run_gnuplot(script); !failure.empty()) notes.push_back(failure);
    outputs.write(
        [&] { write_atomically(options.folder / "index.html", page_of(options, measurement, figures)); });
    return notes;
}

}  // namespace etendue
