// CODE V sequences (.seq): commands, of which those of a surface stand behind S; several on a line are parted
// by semicolons.
#include <algorithm>
#include <map>
#include <set>

#include "host/lens/prescription_text.h"

namespace etendue {
namespace {

// A surface's place: tilts in degrees, alpha and beta left-handed, gamma right-handed.
struct Decentre {
    enum class Kind { none, basic, returning, reverse, bend } kind = Kind::none;
    glm::dvec3 shift{0}, tilt{0};
};

class SeqReader {
  public:
    explicit SeqReader(const TextLines& text) : text_(text) {}

    Prescription read() {
        for (line_ = 0; line_ < text_.lines.size(); ++line_) {
            std::string whole = text_.lines[line_];
            for (; !whole.empty() && whole.back() == '&' && line_ + 1 < text_.lines.size(); ++line_)
                whole.back() = ' ', whole += text_.lines[line_ + 1];
            for (std::string& command : commands_of(whole)) {
                words_ = words_of(command);
                if (!words_.empty()) read_command(upper(words_[0]));
            }
        }
        if (p_.surfaces.empty())
            fail_input("{}: no surface; must be a CODE V sequence with lines SO, S and SI", text_.file);
        set_curvatures();
        place_surfaces();
        for (size_t i = 0; i < p_.wavelengths.size() && i < weights_.size(); ++i)
            p_.wavelengths[i].weight = weights_[i];
        finish_prescription(text_, p_, mm_);
        return p_;
    }

  private:
    // Parted by semicolons, without remarks and what is quoted.
    static std::vector<std::string> commands_of(const std::string& line) {
        std::vector<std::string> commands(1);
        char quote = 0;
        for (const char c : line) {
            if (quote) {
                if (c == quote) quote = 0;
            } else if (c == '\'' || c == '"')
                quote = c, commands.back() += ' ';
            else if (c == '!')
                break;
            else if (c == ';')
                commands.emplace_back();
            else
                commands.back() += c;
        }
        return commands;
    }

    double number(size_t i) const {
        if (i >= words_.size())
            text_.fail(line_, "{} has {} value(s); must have at least {}", words_[0], words_.size() - 1, i);
        return text_.number(line_, words_[i], words_[0]);
    }
    std::string word(size_t i) const { return i < words_.size() ? upper(words_[i]) : ""; }
    LensSurface& surface() {
        if (p_.surfaces.empty()) text_.fail(line_, "{} stands before any surface S", words_[0]);
        return p_.surfaces.back();
    }

    void read_command(const std::string& key) {
        if (key == "SO" || key == "S" || key == "SI") return start_surface(key);
        if (key.size() > 1 && key[0] == 'S' && key.find_first_not_of("0123456789", 1) == key.npos)
            return start_surface(key);
        if (!read_system(key) && !read_field(key)) read_surface(key);
    }

    void start_surface(const std::string& key) {
        const double curve = number(1), thickness = number(2);
        if (key == "SO" || key == "S0") {
            p_.object_distance = thickness;
            if (words_.size() > 3) p_.object_glass = required_glass(text_, line_, words_[3], {});
            return;
        }
        LensSurface s;
        s.shape.curvature = curve;  // or radius: set_curvatures
        s.thickness = thickness;
        const std::string glass = word(3);
        if (glass == "REFL")
            s.is_mirror = true;
        else if (!glass.empty() && glass != "AIR")
            s.glass = required_glass(text_, line_, words_[3], {});
        if (s.is_mirror) s.glass = p_.glass_before(p_.surfaces.size());
        p_.surfaces.push_back(s), decentres_.emplace_back();
    }

    bool read_system(const std::string& key) {
        using Pupil = Prescription::PupilKind;
        const auto pupil = [&](Pupil kind, double value) { p_.pupil_kind = kind, p_.pupil = value; };
        if (key == "RDM")
            is_radius_ = word(1) != "N" && word(1) != "NO";
        else if (key == "TIT" || key == "TITLE") {
            const std::string& line = text_.lines[line_];
            const size_t first = line.find_first_of("'\""), last = line.find_last_of("'\"");
            if (first != line.npos && last > first) p_.title = line.substr(first + 1, last - first - 1);
        } else if (key == "DIM") {
            static const std::map<std::string, double> units = {{"M", 1}, {"C", 10}, {"I", 25.4}};
            const auto found = units.find(word(1).substr(0, 1));
            if (found == units.end()) text_.fail(line_, "DIM {}; must be M, C or I", word(1));
            mm_ = found->second;
        } else if (key == "WL") {
            for (size_t i = 1; i < words_.size(); ++i) p_.wavelengths.push_back({number(i), 1});
        } else if (key == "WTW") {
            for (size_t i = 1; i < words_.size(); ++i) weights_.push_back(number(i));
        } else if (key == "REF")
            p_.primary = text_.count(line_, number(1), "REF", 1, 1000) - 1;
        else if (key == "EPD")
            pupil(Pupil::entrance_diameter, number(1));
        else if (key == "FNO")
            pupil(Pupil::working_f_number, number(1));
        else if (key == "NA")
            pupil(Pupil::working_f_number, 0.5 / number(1));
        else if (key == "NAO")
            pupil(Pupil::object_aperture, number(1));
        else
            return false;
        return true;
    }

    bool read_field(const std::string& key) {
        using Field = Prescription::FieldKind;
        static const std::map<std::string, Field> kinds = {{"AN", Field::angle},
                                                           {"OB", Field::object_height},
                                                           {"IM", Field::paraxial_image_height},
                                                           {"RI", Field::real_image_height}};
        const bool is_value =
            key.size() == 3 && (key[0] == 'X' || key[0] == 'Y') && kinds.count(key.substr(1));
        static const std::set<std::string> edges = {"VUX", "VLX", "VUY", "VLY"};
        if (!is_value && !edges.count(key)) return false;
        const int axis = (is_value ? key[0] : key[2]) == 'Y';
        if (is_value) p_.field_kind = kinds.at(key.substr(1));
        if (p_.fields.size() + 1 < words_.size()) p_.fields.resize(words_.size() - 1);
        for (size_t i = 1; i < words_.size(); ++i) {
            LensField& f = p_.fields[i - 1];
            if (is_value) {
                f.value[axis] = number(i);
            } else {  // the upper or lower edge moves inward by a part of the radius
                f.pupil_compression[axis] += 0.5 * number(i);
                f.pupil_shift[axis] += (key[1] == 'U' ? -0.5 : 0.5) * number(i);
            }
        }
        return true;
    }

    void read_surface(const std::string& key) {
        static const std::set<std::string> refused = {"AAS", "XTO", "YTO", "CYL", "UDS", "XYP", "ZRN",
                                                      "SPS", "DIF", "GRT", "ARR", "SPL", "ODD"};
        if (refused.count(key)) text_.fail(line_, "a surface of kind {}; must be SPH, CON or ASP", key);
        if (key == "STO") {
            surface();
            p_.stop = p_.surfaces.size() - 1;
        } else if (key == "K")
            surface().shape.conic = number(1);
        else if (key == "GLA")
            surface().glass = required_glass(text_, line_, word(1), {});
        else if (key == "THI" && words_.size() == 2)
            surface().thickness = number(1);
        else if (key.size() == 1 && std::string("ABCDEFGHJ").find(key) != std::string::npos &&
                 !p_.surfaces.empty()) {
            auto& coefficients = surface().shape.coefficients;  // A is that of r⁴
            const size_t at = std::string(".ABCDEFGHJ").find(key);
            if (coefficients.size() <= at) coefficients.resize(at + 1, 0);
            coefficients[at] = number(1);
        } else if (key == "CIR" || key == "REX" || key == "REY")
            read_aperture(key);
        else if (key == "ADX")
            surface().aperture.center.x = number(1);
        else if (key == "ADY")
            surface().aperture.center.y = number(1);
        else
            read_decentre(key);
    }

    void read_aperture(const std::string& key) {
        LensAperture& a = surface().aperture;
        const std::string kind = word(1);
        const bool is_inner = kind == "OBS" || kind == "HOL";
        if (kind == "EDG") return;
        const double size = number(words_.size() - 1);
        if (!(size >= 0)) text_.fail(line_, "{} {}; must not be negative", key, size);
        if (is_inner && key != "CIR") {
            p_.warnings.push_back(
                fmt::format("surface {}: {} {} is left out", p_.surfaces.size(), key, kind));
            return;
        }
        (key == "REX"   ? a.half_size.x
         : key == "REY" ? a.half_size.y
         : is_inner     ? a.inner_radius
                        : a.semi_diameter) = size;
        a.is_stated = true;
    }

    void read_decentre(const std::string& key) {
        using Kind = Decentre::Kind;
        static const std::map<std::string, Kind> kinds = {
            {"DAR", Kind::returning}, {"REV", Kind::reverse}, {"BEN", Kind::bend}};
        static const std::string shifts[] = {"XDE", "YDE", "ZDE"}, tilts[] = {"ADE", "BDE", "CDE"};
        if (const auto found = kinds.find(key); found != kinds.end()) {
            surface();
            decentres_.back().kind = found->second;
        }
        for (int i = 0; i < 3; ++i) {
            if (key != shifts[i] && key != tilts[i]) continue;
            surface();
            Decentre& d = decentres_.back();
            (key == shifts[i] ? d.shift : d.tilt)[i] = number(1);
            if (d.kind == Kind::none) d.kind = Kind::basic;
        }
    }

    // Surfaces are given by radius or by curvature, as RDM says; where it does not, numbers that are all
    // below 1 are curvatures.
    void set_curvatures() {
        if (!is_radius_) {
            is_radius_ = !std::all_of(p_.surfaces.begin(), p_.surfaces.end(),
                                      [](auto& s) { return std::abs(s.shape.curvature) < 1; });
            p_.warnings.push_back(fmt::format("RDM is not stated: surfaces are read as {}",
                                              *is_radius_ ? "radii" : "curvatures"));
        }
        if (!*is_radius_) return;
        for (LensSurface& s : p_.surfaces)
            if (s.shape.curvature != 0) s.shape.curvature = 1 / s.shape.curvature;
    }

    // Changes of frame before and behind the surfaces that are decentred.
    void place_surfaces() {
        using Kind = Decentre::Kind;
        std::vector<LensSurface> placed;
        size_t stop = 0;
        for (size_t i = 0; i < p_.surfaces.size(); ++i) {
            const Decentre& d = decentres_[i];
            LensSurface s = p_.surfaces[i];
            s.label = std::to_string(i + 1);
            const glm::dmat3 turn =
                turn_about(0, -d.tilt.x) * turn_about(1, -d.tilt.y) * turn_about(2, d.tilt.z);
            const FrameChange there{d.shift, turn}, back{-(d.shift * turn), glm::transpose(turn)};
            const auto change = [&](const FrameChange& frame, const Glass& glass) {
                LensSurface c;
                c.frame_change = frame, c.glass = glass, c.label = s.label;
                placed.push_back(c);
            };
            if (d.kind != Kind::none && d.kind != Kind::reverse) change(there, p_.glass_before(i));
            if (i == p_.stop) stop = placed.size();
            placed.push_back(s);
            if (d.kind == Kind::none || d.kind == Kind::basic) continue;
            placed.back().thickness = 0;
            change(d.kind == Kind::bend ? FrameChange{glm::dvec3(0), turn} : back, s.glass);
            placed.back().thickness = s.thickness;
        }
        p_.surfaces = std::move(placed), p_.stop = stop;
    }

    const TextLines& text_;
    size_t line_ = 0;
    std::vector<std::string> words_;
    std::vector<Decentre> decentres_;  // of each surface
    std::vector<double> weights_;
    std::optional<bool> is_radius_;
    double mm_ = 1;
    Prescription p_;
};

}  // namespace

Prescription read_seq(const TextLines& text) { return SeqReader(text).read(); }

}  // namespace etendue
