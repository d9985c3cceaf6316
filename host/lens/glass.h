// What lenses are made of: refractive indices relative to air.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace etendue {

// Air, an index, or a formula over the wavelength.
class Glass {
  public:
    Glass() = default;  // air
    static Glass constant(const std::string& name, double index);
    // As for sellmeier_index; `first_nm` to `last_nm`: where the formula holds.
    static Glass sellmeier(const std::string& name, std::vector<double> coefficients, double first_nm,
                           double last_nm);
    // A glass known by nd (at 587.5618 nm) and its Abbe number vd alone: n = A + B/λ², with nF - nC =
    // (nd - 1)/vd. vd = 0: no dispersion.
    static Glass model(const std::string& name, double nd, double vd);

    const std::string& name() const { return name_; }
    bool is_air() const { return name_.empty(); }
    double index(double nm) const;
    // Whether the data hold at that wavelength; an index alone holds at all.
    bool covers(double nm) const { return nm >= first_nm_ && nm <= last_nm_; }
    bool operator==(const Glass&) const = default;

    enum class Formula { constant, sellmeier, cauchy };
    Formula formula() const { return formula_; }
    const std::vector<double>& coefficients() const { return coefficients_; }

  private:
    std::string name_;
    Formula formula_ = Formula::constant;
    std::vector<double> coefficients_ = {1};
    double first_nm_ = 0, last_nm_ = 1e9;
};

// A glass of the catalogues that come with the program (glasses.json, made by tools/make_glasses.py), or a
// substance of the spectra ("SILICA", "PMMA", "POLYCARB", "WATER"). Names as lens files have them: of any
// case, with or without hyphens, with the maker behind an underscore ("NBK7_SCHOTT"). Of a name that several
// makers use that of the first of `makers` counts, then those of the catalogues in their order. Null = there
// is none.
const Glass* find_glass(const std::string& name, std::span<const std::string> makers = {});
std::string known_makers();  // for messages

}  // namespace etendue
