// Plots are drawn by gnuplot, where it is installed.
#pragma once
#include <string>

namespace etendue {

// Where it fails, one line that says why; else nothing.
std::string run_gnuplot(const std::string& script);

std::string quoted_for_gnuplot(const std::string& text);  // text of a script; a quote within is doubled

}  // namespace etendue
