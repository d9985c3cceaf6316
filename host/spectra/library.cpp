#include "host/spectra/library.h"

#include "host/embedded_files.h"

namespace etendue {
namespace {

const nlohmann::json& library() {
    static const nlohmann::json json = nlohmann::json::parse(embedded_spectra().front().bytes);
    return json;
}

}  // namespace

const nlohmann::json* find_named_spectrum(const std::string& name) {
    const auto found = library().find(name);
    return found == library().end() ? nullptr : &*found;
}

std::vector<std::string> named_spectra() {
    std::vector<std::string> names;
    for (const auto& item : library().items()) names.push_back(item.key());
    return names;
}

SpectralTable library_table(const std::string& name, Outside outside) {
    const nlohmann::json& value = library().at(name);
    return interpolate(value.at("wavelengths").get<std::vector<double>>(),
                       value.at("values").get<std::vector<double>>(), outside);
}

}  // namespace etendue
