// Zemax lens files, sequential (.zmx): lines of a key and values; those of surfaces stand behind SURF.
#include <map>

#include "host/lens/prescription_text.h"

namespace etendue {
namespace {

struct ZmxSurface {
    LensSurface surface;
    std::string type = "STANDARD";
    std::map<size_t, double> parameters;
    size_t line = 0;
    bool is_stop = false;
};

class ZmxReader {
  public:
    explicit ZmxReader(const TextLines& text) : text_(text) {}

    Prescription read() {
        for (line_ = 0; line_ < text_.lines.size(); ++line_) {
            words_ = words_of(text_.lines[line_]);
            if (words_.empty()) continue;
            if (words_[0] == "SURF")
                surfaces_.emplace_back().line = line_;
            else if (surfaces_.empty())
                read_header();
            else
                read_surface(surfaces_.back());
        }
        if (surfaces_.empty())
            fail_input("{}: no line SURF; must be a sequential lens file of Zemax", text_.file);
        p_.wavelengths.resize(std::min(p_.wavelengths.size(), wavelength_count_));
        p_.fields.resize(std::min(p_.fields.size(), field_count_));
        p_.object_distance = surfaces_[0].surface.thickness, p_.object_glass = surfaces_[0].surface.glass;
        for (size_t i = 1; i < surfaces_.size(); ++i) {
            if (surfaces_[i].is_stop) p_.stop = i - 1;
            add(surfaces_[i]);
        }
        finish_prescription(text_, p_, mm_);
        return p_;
    }

  private:
    // The number in that place of the line.
    double number(size_t i) const {
        if (i >= words_.size())
            text_.fail(line_, "{} has {} value(s); must have at least {}", words_[0], words_.size() - 1, i);
        return text_.number(line_, words_[i], words_[0]);
    }
    double number_or(size_t i, double other) const { return i < words_.size() ? number(i) : other; }
    size_t whole(size_t i, size_t least, size_t most) const {
        return text_.count(line_, number(i), words_[0], least, most);
    }
    LensField& field(size_t i) {
        if (p_.fields.size() <= i) p_.fields.resize(i + 1);
        return p_.fields[i];
    }
    template <class Member>
    void read_fields(Member member, int axis) {
        for (size_t i = 1; i < words_.size(); ++i) (field(i - 1).*member)[axis] = number(i);
    }
    LensWavelength& wavelength(size_t i) {
        if (p_.wavelengths.size() <= i) p_.wavelengths.resize(i + 1, {550, 1});
        return p_.wavelengths[i];
    }

    void read_header() {
        using Pupil = Prescription::PupilKind;
        using Field = Prescription::FieldKind;
        const std::string& key = words_[0];
        if (key == "MODE" && words_.size() > 1 && words_[1] != "SEQ")
            text_.fail(line_, "MODE {}; must be SEQ", words_[1]);
        else if (key == "NAME")
            p_.title = trimmed(std::string_view(text_.lines[line_]).substr(4));
        else if (key == "UNIT")
            read_unit();
        else if (key == "GCAT")
            makers_.assign(words_.begin() + 1, words_.end());
        else if (key == "ENPD")
            p_.pupil_kind = Pupil::entrance_diameter, p_.pupil = number(1);
        else if (key == "FNUM")
            p_.pupil_kind = number_or(2, 0) == 1 ? Pupil::working_f_number : Pupil::f_number,
            p_.pupil = number(1);
        else if (key == "OBNA")
            p_.pupil_kind = Pupil::object_aperture, p_.pupil = number(1);
        else if (key == "FLOA")
            p_.pupil_kind = Pupil::stop_size;
        else if (key == "FTYP") {
            constexpr Field kinds[] = {Field::angle, Field::object_height, Field::paraxial_image_height,
                                       Field::real_image_height};
            p_.field_kind = kinds[whole(1, 0, 3)], p_.is_telecentric = number_or(2, 0) == 1;
            if (words_.size() > 3) field_count_ = whole(3, 1, 1000);
            if (words_.size() > 4) wavelength_count_ = whole(4, 1, 1000);
        } else if (key == "XFLN")
            read_fields(&LensField::value, 0);
        else if (key == "YFLN")
            read_fields(&LensField::value, 1);
        else if (key == "VDXN")
            read_fields(&LensField::pupil_shift, 0);
        else if (key == "VDYN")
            read_fields(&LensField::pupil_shift, 1);
        else if (key == "VCXN")
            read_fields(&LensField::pupil_compression, 0);
        else if (key == "VCYN")
            read_fields(&LensField::pupil_compression, 1);
        else if (key == "WAVM")
            wavelength(whole(1, 1, 1000) - 1) = {1000 * number(2), number_or(3, 1)};
        else if (key == "WAVL")
            for (size_t i = 1; i < words_.size(); ++i) wavelength(i - 1).nm = 1000 * number(i);
        else if (key == "WWGT")
            for (size_t i = 1; i < words_.size(); ++i) wavelength(i - 1).weight = number(i);
        else if (key == "PWAV")
            p_.primary = whole(1, 1, 1000) - 1;
    }

    void read_unit() {
        static const std::map<std::string, double> units = {
            {"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}, {"M", 1000}};
        const auto found = units.find(words_.size() > 1 ? words_[1] : "");
        if (found == units.end())
            text_.fail(line_, "UNIT {}; must be MM, CM, IN, METER or M", words_.size() > 1 ? words_[1] : "");
        mm_ = found->second;
    }

    void read_surface(ZmxSurface& z) {
        LensSurface& s = z.surface;
        const std::string& key = words_[0];
        if (key == "TYPE")
            z.type = words_.size() > 1 ? words_[1] : "";
        else if (key == "STOP")
            z.is_stop = true;
        else if (key == "CURV")
            s.shape.curvature = number(1);
        else if (key == "CONI")
            s.shape.conic = number(1);
        else if (key == "PARM")
            z.parameters[whole(1, 0, 1000)] = number(2);
        else if (key == "DISZ")
            s.thickness = words_.size() > 1 && words_[1] == "INFINITY" ? infinite : number(1);
        else if (key == "GLAS")
            read_glass(s);
        else if (key == "DIAM")
            read_diameter(s.aperture);
        else if (key == "CLAP" || key == "FLAP") {
            s.aperture.inner_radius = number(1), s.aperture.semi_diameter = number(2),
            s.aperture.is_stated = true;
        } else if (key == "OBSC")
            s.aperture.inner_radius = number(2), s.aperture.is_stated = true;
        else if (key == "SQAP")
            s.aperture.half_size = {number(1), number(2)}, s.aperture.is_stated = true;
        else if (key == "OBDC")
            s.aperture.center = {number(1), number(2)};
        else if (key == "ELAP" || key == "SPID" || key == "UDAP" || key == "SQOB" || key == "ELOB" ||
                 key == "SCBD")
            p_.warnings.push_back(
                fmt::format("surface {}: {} is left out: apertures are circles, rings and rectangles",
                            surfaces_.size() - 1, key));
    }

    void read_diameter(LensAperture& a) {
        const double semi = number(1);
        if (semi < 0) text_.fail(line_, "a semi-diameter of {}; must not be negative", semi);
        if (semi == 0 || a.is_stated) return;  // not told
        a.semi_diameter = semi, a.is_stated = number_or(2, 0) == 1;
    }

    void read_glass(LensSurface& s) {
        if (words_.size() < 2) text_.fail(line_, "GLAS names no glass");
        const std::string& name = words_[1];
        const double kind = number_or(2, 0), nd = number_or(4, 0), vd = number_or(5, 0);
        if (name == "MIRROR")
            s.is_mirror = true;
        else if (kind != 1 && name != "___BLANK" && find_glass(name, makers_))
            s.glass = *find_glass(name, makers_);
        else if ((kind != 0 || name == "___BLANK") && nd > 1)
            s.glass = Glass::model(name, nd, vd);  // a model, or picked up from one
        else
            s.glass = required_glass(text_, line_, name, makers_);
    }

    double parameter(const ZmxSurface& z, size_t i) const {
        const auto found = z.parameters.find(i);
        return found == z.parameters.end() ? 0 : found->second;
    }

    void add(const ZmxSurface& z) {
        LensSurface s = z.surface;
        const auto parameters_from = [&](size_t first) {
            for (size_t i = first; i <= 8; ++i) s.shape.coefficients.push_back(parameter(z, i));
            while (!s.shape.coefficients.empty() && s.shape.coefficients.back() == 0)
                s.shape.coefficients.pop_back();
        };
        if (z.type == "COORDBRK") {
            s = LensSurface{.thickness = s.thickness, .glass = s.glass};
            s.frame_change = frame_change(z);
        } else if (z.type == "EVENASPH") {
            parameters_from(1);
        } else if (z.type == "TOROIDAL" && parameter(z, 1) == 0) {  // turns about an axis at infinity
            s.shape.is_cylinder = true;
            parameters_from(2);
        } else if (z.type == "DGRATING") {
            s.grating = LensGrating{1000 * parameter(z, 1), parameter(z, 2)};
        } else if (z.type != "STANDARD") {
            text_.fail(z.line,
                       "a surface of type {}; must be STANDARD, EVENASPH, COORDBRK, DGRATING, or TOROIDAL "
                       "with a radius of rotation of 0",
                       z.type);
        }
        if (s.is_mirror || s.frame_change) s.glass = p_.glass_before(p_.surfaces.size());
        p_.surfaces.push_back(s);
    }

    // Tilts are right-handed; order 0: shift, then x, y, z; else z, y, x, then shift.
    FrameChange frame_change(const ZmxSurface& z) const {
        const glm::dmat3 x = turn_about(0, parameter(z, 3)), y = turn_about(1, parameter(z, 4)),
                         w = turn_about(2, parameter(z, 5));
        const glm::dvec3 shift(parameter(z, 1), parameter(z, 2), 0);
        if (parameter(z, 6) == 0) return {shift, x * y * w};
        const glm::dmat3 turn = w * y * x;
        return {turn * shift, turn};
    }

    const TextLines& text_;
    size_t line_ = 0;
    std::vector<std::string> words_, makers_;
    std::vector<ZmxSurface> surfaces_;
    size_t field_count_ = 1000, wavelength_count_ = 1000;
    double mm_ = 1;
    Prescription p_;
};

}  // namespace

Prescription read_zmx(const TextLines& text) { return ZmxReader(text).read(); }

}  // namespace etendue
