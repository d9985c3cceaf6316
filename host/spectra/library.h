// The spectra that come with the program (library.json, made by tools/make_spectra.py; each with its source).
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/spectra/spectrum.h"

namespace etendue {

// A spectral value of the scene format by its name ("BK7 ior", "Au eta", "illuminant D65"); null = none.
const nlohmann::json* find_named_spectrum(const std::string& name);
std::vector<std::string> named_spectra();
// The same as a table; it must be there and be tabulated.
SpectralTable library_table(const std::string& name, Outside outside);

}  // namespace etendue
