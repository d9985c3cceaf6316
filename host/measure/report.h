// The report of a measurement: a folder with
//   index.html               a page of its own: figures, maps, sections, polar diagrams, the balance of power
//   figures.csv              every figure of every meter, with its interval
//   balance.csv              where the light has gone, by material, where forward rays tell
//   METER.exr, METER.csv     each pixel and its standard error; of a meter on a surface the table is by
//   triangle METER.ies, METER.ldt     of intensities, as lamps are published (LM-63-2019, EULUMDAT)
//   METER.tm25ray            the rays that a receiver has recorded (TM-25)
//   METER.map.png            in false colours with isolines
//   METER.sections.svg       through the middle, with the 95 % interval; of intensities METER.polar.svg
#pragma once
#include <filesystem>
#include <map>

#include "host/image/outputs.h"
#include "host/measure/figures.h"
#include "host/measure/measurement.h"
#include "host/photometry/intensity_distribution.h"
#include "host/table.h"

namespace etendue {

struct ReportOptions {
    std::filesystem::path folder;
    std::vector<MeterPoint> points;  // for uniformity; empty = none
    double glare_from = usual_glare_from;
    std::map<std::string, Attribute>
        attributes;  // of the images, and named on the page: scene, command, seed …
};

// Of each meter, in their order. What is told of a measurement, in files and on a terminal, takes these: many
// pixels take a while.
using MeterFigures = std::vector<std::vector<Figure>>;
MeterFigures all_figures(const ReportOptions& options, const Measurement& measurement);

// What a meter has read, for a terminal; the page has the same tables.
Table figure_table(const std::vector<Figure>& figures);

// Returns lines for the user: what could not be drawn.
std::vector<std::string> write_report(const ReportOptions& options, const Measurement& measurement,
                                      const MeterFigures& figures, Outputs& outputs);

// What --error asks: the worst of all meters, of those that light has reached; of their means or worst
// pixels.
double relative_error(const Measurement& measurement, bool worst);

// Names of the meters in files, each once.
std::vector<std::string> file_names(const Measurement& measurement);

// What an intensity meter has read, as photometric files hold it: the mean over each pixel's solid angle
// stands for its direction.
IntensityDistribution intensity_distribution(const Readings& readings);

// What gnuplot is to draw of a meter; the files' names begin with `stem`.
std::string plots_of(const Readings& readings, const std::filesystem::path& stem);

// Where the light has gone, in lm: emitted = absorbed + escaped + lost + roulette + difference. Lines
// "absorbed by …" are parts of absorbed; meters take no light, so that what they received is in one of the
// others, too. Empty where there were no forward rays.
struct BalanceLine {
    std::string name;
    double flux;
    std::string text;
};
std::vector<BalanceLine> balance_of(const Measurement& measurement);

// The page; it holds the plots that are in the folder.
std::string page_of(const ReportOptions& options, const Measurement& measurement,
                    const MeterFigures& figures);

}  // namespace etendue
