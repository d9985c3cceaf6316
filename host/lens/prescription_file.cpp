#include <cctype>
#include <numbers>

#include "host/image/atomic_file.h"
#include "host/lens/prescription_text.h"
#include "host/lens/pupil_rays.h"

namespace etendue {
namespace {

constexpr size_t most_bytes = 16 << 20, most_surfaces = 1000, most_fields = 100, most_wavelengths = 50;

void append_utf8(std::string& text, char32_t c) {
    if (c < 0x80)
        text += char(c);
    else if (c < 0x800)
        text += {char(0xC0 | c >> 6), char(0x80 | (c & 0x3F))};
    else if (c < 0x10000)
        text += {char(0xE0 | c >> 12), char(0x80 | (c >> 6 & 0x3F)), char(0x80 | (c & 0x3F))};
    else
        text += {char(0xF0 | c >> 18), char(0x80 | (c >> 12 & 0x3F)), char(0x80 | (c >> 6 & 0x3F)),
                 char(0x80 | (c & 0x3F))};
}

// UTF-16 with a mark of its order, or Latin-1 or UTF-8, as they are: what counts is ASCII, and messages show
// any other byte.
std::string decoded(const std::vector<std::byte>& bytes) {
    const auto byte = [&](size_t i) { return char32_t(bytes[i]); };
    const bool little = bytes.size() > 1 && byte(0) == 0xFF && byte(1) == 0xFE;
    const bool big = bytes.size() > 1 && byte(0) == 0xFE && byte(1) == 0xFF;
    if (!little && !big) return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    std::string text;
    const auto unit = [&](size_t i) {
        return little ? byte(i) | byte(i + 1) << 8 : byte(i) << 8 | byte(i + 1);
    };
    for (size_t i = 2; i + 1 < bytes.size(); i += 2) {
        char32_t c = unit(i);
        if (c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size())
            c = 0x10000 + ((c - 0xD800) << 10) + ((unit(i += 2) - 0xDC00) & 0x3FF);
        append_utf8(text, c);
    }
    return text;
}

void scale(LensSurface& s, double mm) {
    s.shape.curvature /= mm;
    double power = mm;  // of a coefficient of r² is 1/mm
    for (double& a : s.shape.coefficients) a /= power, power *= mm * mm;
    s.thickness *= mm;
    LensAperture& a = s.aperture;
    a.semi_diameter *= mm, a.inner_radius *= mm, a.half_size *= mm, a.center *= mm;
    if (s.frame_change) s.frame_change->shift *= mm;
}

}  // namespace

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    const char* const blanks = " \t,";
    for (size_t begin = 0; (begin = line.find_first_not_of(blanks, begin)) != line.npos;) {
        const size_t end = std::min(line.find_first_of(blanks, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = end;
    }
    return words;
}

std::string upper(std::string text) {
    for (char& c : text) c = char(std::toupper((unsigned char)c));
    return text;
}

std::optional<Glass> coded_glass(const std::string& code) {
    const size_t point = code.find('.');
    const std::string digits = code.substr(0, point) + (point == code.npos ? "" : code.substr(point + 1));
    if (digits.size() < 6 || digits.find_first_not_of("0123456789") != digits.npos) return {};
    if (point == code.npos) {
        if (digits.size() != 6) return {};
        return Glass::model(code, 1 + std::stod("0." + code.substr(0, 3)), std::stod(code.substr(3)) / 10);
    }
    const std::string behind = code.substr(point + 1);
    if (behind.size() < 2) return {};
    return Glass::model(code, 1 + std::stod("0." + code.substr(0, point)),
                        std::stod(behind.substr(0, 2) + "." + behind.substr(2) + "0"));
}

Glass required_glass(const TextLines& text, size_t line, const std::string& name,
                     std::span<const std::string> makers) {
    if (const Glass* glass = find_glass(name, makers)) return *glass;
    if (auto glass = coded_glass(name)) return *glass;
    text.fail(line, "no data of the glass '{}'; known are those of {}, codes like 517642, and indices", name,
              known_makers());
}

glm::dmat3 turn_about(int axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    glm::dmat3 turn(1);  // columns are the new axes
    turn[u][u] = c, turn[u][v] = s, turn[v][u] = -s, turn[v][v] = c;
    return turn;
}

void finish_prescription(const TextLines& text, Prescription& p, double mm) {
    p.file = text.file;
    if (p.surfaces.size() < 2)
        fail_input("{}: holds {} surface(s) beside the object; must hold at least one and the image",
                   text.file, p.surfaces.size());
    if (p.surfaces.size() > most_surfaces)
        fail_input("{}: holds {} surfaces; must be at most {}", text.file, p.surfaces.size(), most_surfaces);
    if (p.fields.size() > most_fields || p.wavelengths.size() > most_wavelengths)
        fail_input("{}: {} fields and {} wavelengths; must be at most {} and {}", text.file, p.fields.size(),
                   p.wavelengths.size(), most_fields, most_wavelengths);
    p.surfaces.back().thickness = 0;
    p.object_distance *= mm;
    for (size_t i = 0; i < p.surfaces.size(); ++i) {
        LensSurface& s = p.surfaces[i];
        scale(s, mm);
        if (s.label.empty()) s.label = std::to_string(i + 1);
        if (std::isinf(s.thickness))
            fail_input("{}: infinitely thick; only the object may be far", (p.file + ": surface " + s.label));
    }
    using Pupil = Prescription::PupilKind;
    if (p.pupil_kind == Pupil::entrance_diameter) p.pupil *= mm;
    if (p.field_kind != Prescription::FieldKind::angle)
        for (LensField& f : p.fields) f.value *= mm;
    if (p.fields.empty()) p.fields.emplace_back();
    if (p.wavelengths.empty()) p.wavelengths.push_back({587.5618, 1});  // the line d
    for (const LensWavelength& w : p.wavelengths)
        if (!(w.nm >= 10 && w.nm <= 1e5 && w.weight >= 0))
            fail_input(
                "{}: a wavelength of {} nm, weight {}; must be from 10 to 100000, weights not negative",
                text.file, w.nm, w.weight);
    if (p.object_distance >= 1e10) p.object_distance = infinite;
    if (!(p.object_distance > 0) ||
        (std::isinf(p.object_distance) && (p.field_kind == Prescription::FieldKind::object_height ||
                                           p.pupil_kind == Prescription::PupilKind::object_aperture)))
        fail_input(
            "{}: the object is {} mm before the lens; must be above 0, and finite where its size or aperture "
            "counts",
            text.file, p.object_distance);
    if (p.primary >= p.wavelengths.size()) p.primary = 0;
    if (p.stop + 1 >= p.surfaces.size()) fail_input("{}: the image cannot be the stop", text.file);
    if (p.pupil_kind == Pupil::stop_size && std::isinf(p.surfaces[p.stop].aperture.semi_diameter))
        fail_input("{}: states neither a pupil nor the size of its stop", text.file);
    if (p.pupil_kind != Pupil::stop_size && !(p.pupil > 0))
        fail_input("{}: the pupil's size is {}; must be above 0", text.file, p.pupil);
}

Prescription read_prescription(const std::filesystem::path& file) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > most_bytes)
        fail_input("{}: {} bytes; a lens file has at most {}", file.string(), size, most_bytes);
    const TextLines text = text_lines(file.string(), decoded(read_whole_file(file)));
    const std::string kind = upper(file.extension().string());
    Prescription p = kind == ".ZMX"   ? read_zmx(text)
                     : kind == ".SEQ" ? read_seq(text)
                                      : read_lens_table(text);
    check_prescription(p);
    set_missing_semi_diameters(p);
    check_prescription(p);  // with apertures everywhere
    return p;
}

}  // namespace etendue
