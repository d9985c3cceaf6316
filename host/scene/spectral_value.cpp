#include "host/scene/spectral_value.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "host/error.h"
#include "host/scene/scene_files.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"

namespace etendue {
namespace {

using nlohmann::json;

constexpr double d_line = 587.6;  // nm

class Reader {
  public:
    Reader(const SceneDescription& scene, const std::string& where, SpectralKind kind)
        : scene_(scene), place_(message_place(scene, where)), kind_(kind) {}

    SpectralValue read(const json& value, bool may_name = true) const {
        if (value.is_number()) return {glm::vec3(number(value)), {}};
        if (value.is_array() && value.size() == 3)
            return {glm::vec3(number(value[0]), number(value[1]), number(value[2])), {}};
        if (!value.is_object() || value.empty()) fail();
        if (value.contains("name")) return named(value, may_name);
        SpectralTable table;
        if (value.contains("wavelengths"))
            table = tabulated(numbers(value, "wavelengths"), numbers(value, "values"));
        else if (value.contains("file"))
            table = from_file(value);
        else if (value.contains("blackbody"))
            table = blackbody(value);
        else if (value.contains("illuminant"))
            table = illuminant(value);
        else if (value.contains("cauchy"))
            table = formula(numbers(value, "cauchy"), cauchy_index);
        else if (value.contains("sellmeier"))
            table = sellmeier(value);
        else
            fail();
        return {color(table), table};
    }

  private:
    [[noreturn]] void fail() const {
        fail_input(
            "{}: not a spectral value; allowed: a number, [r, g, b], or an object with one of name, "
            "wavelengths and "
            "values, file, blackbody, illuminant, cauchy, sellmeier",
            place_);
    }

    float number(const json& v) const {
        if (!v.is_number() || !std::isfinite(v.get<double>()) || std::abs(v.get<double>()) > 3e38)
            fail_input("{}: {} is not a finite number", place_, v.dump());
        return float(v.get<double>());
    }

    std::vector<double> numbers(const json& value, const char* member) const {
        if (!value.contains(member) || !value[member].is_array() || value[member].empty())
            fail_input("{}/{}: allowed: an array of numbers", place_, member);
        std::vector<double> result;
        for (const json& v : value[member]) {
            number(v);
            result.push_back(v.get<double>());
        }
        return result;
    }

    SpectralValue named(const json& value, bool may_name) const {
        if (!value["name"].is_string()) fail();
        const std::string name = value["name"];
        // A named spectrum may not name another one: that could go round in circles.
        if (!may_name) fail_input("{}: a spectrum that is named names another one, \"{}\"", place_, name);
        if (const auto found = scene_.spectra.find(name); found != scene_.spectra.end())
            return read(found->second, false);
        if (const json* found = find_named_spectrum(name)) return read(*found, false);
        std::string names;
        for (const std::string& n : named_spectra()) names += ", " + n;
        fail_input("{}: {} is not the name of a spectrum; allowed: those of the scene's \"spectra\"{}",
                   place_, value["name"].dump(), names);
    }

    SpectralTable tabulated(const std::vector<double>& nm, const std::vector<double>& values) const {
        if (nm.size() != values.size())
            fail_input("{}: {} wavelengths and {} values; allowed: as many of both", place_, nm.size(),
                       values.size());
        for (size_t i = 0; i < nm.size(); ++i)
            if (!(nm[i] > 0) || (i > 0 && !(nm[i] > nm[i - 1])))
                fail_input("{}: wavelength {}: allowed: numbers above 0 that rise, in nm", place_, nm[i]);
        return interpolate(nm, values, kind_ == SpectralKind::radiance ? Outside::zero : Outside::hold);
    }

    // Lines of "wavelength, value"; a first line of names, empty lines and those after # are left out.
    SpectralTable from_file(const json& value) const {
        if (!value["file"].is_string()) fail_input("{}/file: allowed: the name of a CSV file", place_);
        const std::filesystem::path path = named_file(scene_, value["file"].get<std::string>());
        std::ifstream file(path);
        if (!file) fail_input("{}/file: cannot read {}", place_, path.string());
        std::vector<double> nm, values;
        std::string line;
        for (int count = 1; std::getline(file, line); ++count) {
            line = line.substr(0, line.find('#'));
            for (char& c : line)
                if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
            std::istringstream in(line);
            std::string first, second, rest;
            if (!(in >> first)) continue;
            char *end_first = nullptr, *end_second = nullptr;
            const double w = std::strtod(first.c_str(), &end_first);
            if (*end_first && nm.empty()) continue;
            const bool has_second = bool(in >> second);
            const double v = std::strtod(second.c_str(), &end_second);
            if (*end_first || !has_second || *end_second || in >> rest || !(std::abs(w) < 1e30) ||
                !(std::abs(v) < 1e30))
                fail_input("{}:{}: allowed: lines of two numbers, wavelength in nm and value", path.string(),
                           count);
            nm.push_back(w), values.push_back(v);
        }
        if (nm.empty())
            fail_input("{}: holds no lines of two numbers, wavelength in nm and value", path.string());
        return tabulated(nm, values);
    }

    SpectralTable blackbody(const json& value) const {
        const double kelvin = number(value["blackbody"]);
        if (!(kelvin >= 100 && kelvin <= 1e6))
            fail_input("{}/blackbody: {} is out of range; allowed: [100, 1e6] K", place_, kelvin);
        return tabulate([&](double nm) { return blackbody_radiance(kelvin, nm); });
    }

    SpectralTable illuminant(const json& value) const {
        const std::string name =
            value["illuminant"].is_string() ? value["illuminant"].get<std::string>() : "";
        const std::string key = "illuminant " + name;
        if (!find_named_spectrum(key))
            fail_input("{}/illuminant: {} is none that is known; allowed: A, D65, E, F1 to F12", place_,
                       value["illuminant"].dump());
        const SpectralTable table = library_table(key, Outside::zero);
        return table * (1 / xyz_of_radiance(table).y);
    }

    template <class Index>
    SpectralTable formula(const std::vector<double>& coefficients, Index index) const {
        const SpectralTable table = tabulate([&](double nm) { return index(coefficients, nm); });
        for (const float n : table.values)
            if (!(n >= 0.1f && n <= 100.0f))
                fail_input("{}: gives the refractive index {} between 360 and 830 nm; allowed: [0.1, 100]",
                           place_, n);
        return table;
    }

    SpectralTable sellmeier(const json& value) const {
        const std::vector<double> c = numbers(value, "sellmeier");
        if (c.size() % 2 != 0) fail_input("{}/sellmeier: allowed: as many B as C, all B first", place_);
        return formula(c, sellmeier_index);
    }

    glm::vec3 color(const SpectralTable& table) const {
        switch (kind_) {
            case SpectralKind::radiance:
                return glm::vec3(glm::max(rgb_of_radiance(table), 0.0));
            case SpectralKind::index:
                return glm::vec3(float(table.at(d_line)));
            case SpectralKind::factor:
                break;
        }
        return glm::vec3(rgb_of_factor(table));
    }

    const SceneDescription& scene_;
    std::string place_;
    SpectralKind kind_;
};

}  // namespace

std::string message_place(const SceneDescription& scene, const std::string& where) {
    return fmt::format("{}: {}", scene.file.string(), where.empty() ? "/" : where);
}

SpectralValue spectral_value(const json& value, const SceneDescription& scene, const std::string& where,
                             SpectralKind kind) {
    return Reader(scene, where, kind).read(value);
}

}  // namespace etendue
