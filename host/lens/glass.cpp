#include "host/lens/glass.h"

#include <fmt/ranges.h>

#include <cctype>
#include <map>
#include <nlohmann/json.hpp>

#include "host/embedded_files.h"
#include "host/spectra/library.h"
#include "host/spectra/spectrum.h"

namespace etendue {
namespace {

constexpr double nm_d = 587.5618, nm_F = 486.1327,
                 nm_C = 656.2725;  // lines d, F and C of helium and hydrogen

std::string plain(const std::string& name) {
    std::string letters;
    for (const unsigned char c : name)
        if (std::isalnum(c)) letters += char(std::toupper(c));
    return letters;
}

struct Catalogues {
    std::vector<std::string> makers;                              // in their order
    std::map<std::string, std::map<std::string, Glass>> glasses;  // by maker and plain name

    Catalogues() {
        const auto json = nlohmann::ordered_json::parse(embedded_glasses().front().bytes);
        for (const auto& [maker, catalogue] : json.items()) {
            makers.push_back(maker);
            for (const auto& [name, glass] : catalogue.at("glasses").items())
                glasses[maker].emplace(plain(name),
                                       Glass::sellmeier(name, glass.at("sellmeier"), glass.at("nm").at(0),
                                                        glass.at("nm").at(1)));
        }
        // Substances, with the ranges of their sources.
        const auto add = [&](const char* name, const char* spectrum, double first_nm, double last_nm) {
            glasses["MISC"].emplace(
                name,
                Glass::sellmeier(name, find_named_spectrum(spectrum)->at("sellmeier"), first_nm, last_nm));
        };
        makers.push_back("MISC");
        add("SILICA", "fused silica ior", 210, 6700);
        add("FSILICA", "fused silica ior", 210, 6700);
        add("PMMA", "PMMA ior", 436.8, 1052);
        add("POLYCARB", "polycarbonate ior", 436.8, 1052);
        add("WATER", "water ior", 182, 1129);
    }
};

const Catalogues& catalogues() {
    static const Catalogues all;
    return all;
}

const Glass* find_in(const std::string& maker, const std::string& name) {
    const auto found = catalogues().glasses.find(plain(maker));
    if (found == catalogues().glasses.end()) return nullptr;
    const auto glass = found->second.find(plain(name));
    return glass == found->second.end() ? nullptr : &glass->second;
}

}  // namespace

Glass Glass::constant(const std::string& name, double index) {
    Glass glass;
    glass.name_ = name, glass.coefficients_ = {index};
    return glass;
}

Glass Glass::sellmeier(const std::string& name, std::vector<double> coefficients, double first_nm,
                       double last_nm) {
    Glass glass;
    glass.name_ = name, glass.formula_ = Formula::sellmeier, glass.coefficients_ = std::move(coefficients);
    glass.first_nm_ = first_nm, glass.last_nm_ = last_nm;
    return glass;
}

Glass Glass::model(const std::string& name, double nd, double vd) {
    if (vd == 0) return constant(name, nd);
    const auto per_square = [](double nm) { return 1e6 / (nm * nm); };  // 1/λ², λ in µm
    const double b = (nd - 1) / vd / (per_square(nm_F) - per_square(nm_C));
    Glass glass;
    glass.name_ = name, glass.formula_ = Formula::cauchy;
    glass.coefficients_ = {nd - b * per_square(nm_d), b};
    return glass;
}

double Glass::index(double nm) const {
    switch (formula_) {
        case Formula::sellmeier:
            return sellmeier_index(coefficients_, nm);
        case Formula::cauchy:
            return cauchy_index(coefficients_, nm);
        default:
            return coefficients_[0];
    }
}

const Glass* find_glass(const std::string& name, std::span<const std::string> makers) {
    if (const size_t mark = name.rfind('_'); mark != name.npos)
        return find_in(name.substr(mark + 1), name.substr(0, mark));
    for (const std::string& maker : makers)
        if (const Glass* glass = find_in(maker, name)) return glass;
    for (const std::string& maker : catalogues().makers)
        if (const Glass* glass = find_in(maker, name)) return glass;
    return nullptr;
}

std::string known_makers() { return fmt::format("{}", fmt::join(catalogues().makers, ", ")); }

}  // namespace etendue
