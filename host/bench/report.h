// The results of a bench for readers: a table as text, and a page with tables, plots and images.
#pragma once
#include "host/bench/results.h"

namespace etendue {

using Table = std::vector<std::vector<std::string>>;  // rows of cells; the first names the columns

// A row an algorithm: its longest renders, slopes, and the time to each of some errors.
Table summary_table(const std::vector<BenchCurve>& curves);

std::string as_text(const Table& table);  // columns aligned

// Draws FOLDER/SCENE.seconds.svg and SCENE.rays.svg of every scene with gnuplot. Where that fails, returns
// one line that says why; else nothing.
std::string draw_plots(const std::filesystem::path& folder, const BenchResults& results);

// FOLDER/index.html: one file that holds the plots and the images (SCENE.*.png) that are in the folder.
void write_page(const std::filesystem::path& folder, const BenchResults& results);

}  // namespace etendue
