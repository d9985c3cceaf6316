// Lenses as tables, for those who write them by hand.
#include "host/lens/prescription_text.h"

namespace etendue {
namespace {

LensSurface row_of(const TextLines& text, size_t line, const std::vector<std::string>& words) {
    if (words.size() < 4)
        text.fail(line,
                  "{} values; a surface has radius, thickness, index or glass, diameter, and, if wanted, "
                  "conic constant and coefficients",
                  words.size());
    LensSurface s;
    const double radius = text.number(line, words[0], "the radius");
    s.shape.curvature = radius == 0 ? 0 : 1 / radius;
    s.thickness = text.number(line, words[1], "the thickness");
    if (double index; parse_number(words[2], index)) {
        if (!(index >= 1 && index <= 10)) text.fail(line, "the index is {}; must be from 1 to 10", index);
        if (index != 1) s.glass = Glass::constant(words[2], index);
    } else if (upper(words[2]) == "MIRROR") {
        s.is_mirror = true;
    } else if (upper(words[2]) != "AIR") {
        s.glass = required_glass(text, line, words[2], {});
    }
    const double diameter = text.number(line, words[3], "the diameter");
    if (!(diameter > 0)) text.fail(line, "the diameter is {}; must be above 0", diameter);
    s.aperture.semi_diameter = 0.5 * diameter, s.aperture.is_stated = true;
    if (words.size() > 4) s.shape.conic = text.number(line, words[4], "the conic constant");
    if (words.size() > 5) s.shape.coefficients.push_back(0);  // of r²
    for (size_t i = 5; i < words.size(); ++i)
        s.shape.coefficients.push_back(text.number(line, words[i], "a coefficient"));
    return s;
}

}  // namespace

Prescription read_lens_table(const TextLines& text) {
    Prescription p;
    std::optional<size_t> stop, plane_in_air;
    for (size_t line = 0; line < text.lines.size(); ++line) {
        std::string row = text.lines[line];
        if (const size_t remark = row.find('#'); remark != row.npos) row.resize(remark);
        std::vector<std::string> words = words_of(row);
        if (words.empty()) continue;
        const auto number = [&](size_t i, const char* what) { return text.number(line, words[i], what); };
        const std::string key = upper(words[0]);
        if (key == "TITLE") {
            p.title = trimmed(std::string_view(row).substr(row.find(words[0]) + words[0].size()));
        } else if (key == "FIELDS") {
            for (size_t i = 1; i < words.size(); ++i)
                p.fields.push_back({{0, number(i, "a field, in degrees")}});
        } else if (key == "WAVELENGTHS") {
            for (size_t i = 1; i < words.size(); ++i)
                p.wavelengths.push_back({number(i, "a wavelength, in nm"), 1});
            p.primary = p.wavelengths.size() / 2;
        } else if (key == "OBJECT" && words.size() == 2) {
            p.object_distance = number(1, "the object's distance");
        } else {
            if (upper(words.back()) == "STOP") stop = p.surfaces.size(), words.pop_back();
            LensSurface s = row_of(text, line, words);
            if (s.is_mirror) s.glass = p.glass_before(p.surfaces.size());
            if (!plane_in_air && s.shape.curvature == 0 && s.glass.is_air() &&
                p.glass_before(p.surfaces.size()).is_air())
                plane_in_air = p.surfaces.size();
            p.surfaces.push_back(s);
        }
    }
    p.stop = stop.value_or(plane_in_air.value_or(0));
    if (!p.surfaces.empty()) {
        LensSurface image;  // behind the last thickness
        image.glass = p.surfaces.back().glass;
        p.surfaces.push_back(image);
    }
    finish_prescription(text, p, 1);
    return p;
}

}  // namespace etendue
