// The results of a bench for readers: a table as text, and a page with tables, plots and images.
#pragma once
#include "host/bench/results.h"
#include "host/table.h"

namespace etendue {

// A row an algorithm: its longest renders, slopes, and the time to each of some errors.
Table summary_table(const std::vector<BenchCurve>& curves);

// Draws FOLDER/SCENE.seconds.svg and SCENE.rays.svg of every scene with gnuplot. Where that fails, returns
// one line that says why; else nothing.
std::string draw_plots(const std::filesystem::path& folder, const BenchResults& results);

// FOLDER/index.html: one file that holds the plots and the images (SCENE.*.png) that are in the folder.
void write_page(const std::filesystem::path& folder, const BenchResults& results);

}  // namespace etendue
