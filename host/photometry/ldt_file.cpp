#include "host/photometry/ldt_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/image/atomic_file.h"
#include "host/photometry/photometric_text.h"

namespace etendue {
namespace {

using Kind = LuminousOpening::Kind;

// One value a line, numbered as in Stockmar's description.
class Fields {
  public:
    explicit Fields(const PhotometricText& text) : text_(text) {}

    const std::string& next(const std::string& what) {
        if (at_ >= text_.lines.size())
            text_.fail(text_.lines.empty() ? 0 : text_.lines.size() - 1, "the file ends before {}", what);
        return text_.lines[at_++];
    }
    double number(const std::string& what) {
        std::string word = next(what);
        std::replace(word.begin(), word.end(), ',', '.');
        return text_.number(line(), word, what);
    }
    double candela(double factor, const std::string& what) {
        const double value = factor * number(what);
        return text_.candela(line(), value, what);
    }
    size_t count(const std::string& what, size_t least, size_t most) {
        const double value = number(what);
        return text_.count(line(), value, what, least, most);
    }
    std::vector<double> angles(const char* name, size_t count, double most) {
        std::vector<double> angles;
        for (size_t i = 0; i < count; ++i) {
            const double a = number(fmt::format("{} angle {} of {}", name, i + 1, count));
            if (!(a >= 0 && a <= most)) fail("{} angle {} is {}°; must be 0 to {}", name, i + 1, a, most);
            if (i > 0 && !(a > angles.back()))
                fail("{} angle {} is {}°, after {}°; angles must rise", name, i + 1, a, angles.back());
            angles.push_back(a);
        }
        return angles;
    }
    template <class... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        text_.fail(line(), format, std::forward<Args>(args)...);
    }

  private:
    size_t line() const { return at_ == 0 ? 0 : at_ - 1; }  // of the value that came last
    const PhotometricText& text_;
    size_t at_ = 0;
};

// Length, width and height in mm; the length lies along C90. No width: round.
LuminousOpening opening(double length, double width, double height) {
    LuminousOpening o;
    if (length <= 0) return o;
    o.size = glm::dvec3(width > 0 ? width : length, length, height) * 1e-3;
    o.kind =
        width > 0 ? (height > 0 ? Kind::box : Kind::rectangle) : (height > 0 ? Kind::cylinder : Kind::disk);
    return o;
}

// Which of the planes are stored: the first, and how many. Symmetry makes the others from them.
struct Stored {
    size_t first, count;
};
Stored stored_planes(size_t symmetry, size_t planes) {
    switch (symmetry) {
        case 1:
            return {0, 1};
        case 2:
            return {0, planes / 2 + 1};
        case 3:
            return {planes * 3 / 4, planes / 2 + 1};
        case 4:
            return {0, planes / 4 + 1};
        default:
            return {0, planes};
    }
}

// Of the table up to gamma = 90.
double downward_flux(const IntensityDistribution& d) {
    IntensityDistribution below = d;
    std::erase_if(below.angles, [](double angle) { return angle > 90; });
    below.candela.clear();
    for (size_t p = 0; p < d.planes.size(); ++p)
        for (size_t j = 0; j < below.angles.size(); ++j) below.candela.push_back(d.at(p, j));
    return below.flux();
}

}  // namespace

IntensityDistribution read_ldt(const std::filesystem::path& file) {
    const PhotometricText text = photometric_text(file.string(), read_photometric_bytes(file));
    IntensityDistribution d;
    Fields fields(text);
    d.description.push_back(fields.next("the company"));
    fields.number("the type indicator");
    const size_t symmetry = fields.count("the symmetry indicator", 0, 4);
    const size_t plane_count = fields.count("the number of C planes", 1, max_photometric_angles);
    if (plane_count % (symmetry == 4 || symmetry == 3 ? 4 : symmetry == 2 ? 2 : 1) != 0)
        fields.fail("{} C planes do not fit the symmetry {}", plane_count, symmetry);
    fields.number("the distance between C planes");
    const size_t angle_count = fields.count("the number of angles in a C plane", 2, max_photometric_angles);
    fields.number("the distance between angles");
    if (plane_count * angle_count > max_photometric_values)
        fields.fail("{} x {} intensities; a table has at most {}", plane_count, angle_count,
                    max_photometric_values);
    for (const char* what : {"the report number", "the luminaire's name", "the luminaire's number",
                             "the file's name", "the date"})
        d.description.push_back(fields.next(what));
    for (const char* what : {"the length", "the width", "the height"}) fields.number(what);
    const double length = fields.number("the luminous length"), width = fields.number("the luminous width");
    double height = 0;
    for (const char* what : {"C0", "C90", "C180", "C270"})
        height = std::max(height, fields.number(fmt::format("the luminous height towards {}", what)));
    d.opening = opening(length, width, height);
    fields.number("the downward flux fraction");
    const double output = fields.number("the light output ratio");
    const double conversion = fields.number("the conversion factor");
    fields.number("the tilt");
    const size_t sets = fields.count("the number of sets of lamps", 1, 1000);
    double lamp_flux = 0;
    for (size_t i = 0; i < sets; ++i) {
        fields.number("the number of lamps");
        const std::string type = fields.next("the type of lamps");
        const double flux = fields.number("the lamps' flux");
        fields.next("the lamps' colour"), fields.next("the lamps' colour rendering");
        const double watts = fields.number("the watts");
        if (i > 0) continue;
        lamp_flux = flux, d.watts = watts;
        if (!(flux >= 0)) fields.fail("the lamps' flux is {} lm; must be at least 0", flux);
        if (sets > 1)
            d.warnings.push_back(
                fmt::format("of {} sets of lamps the first one counts: {}, {} lm", sets, type, flux));
    }
    for (int i = 0; i < 10; ++i) fields.number("a direct ratio");

    const std::vector<double> c = fields.angles("C", plane_count, 360);
    d.angles = fields.angles("gamma", angle_count, 180);
    const double scale = lamp_flux / 1000 * (conversion == 0 ? 1 : conversion);
    if (conversion == 0) d.warnings.emplace_back("the conversion factor is 0: taken as 1");
    if (!(scale >= 0)) fields.fail("the conversion factor is {}; must be at least 0", conversion);
    const Stored stored = stored_planes(symmetry, plane_count);
    std::vector<PhotometricPlane> planes;
    for (size_t i = 0; i < stored.count; ++i) {
        const size_t plane = (stored.first + i) % plane_count;
        PhotometricPlane& p = planes.emplace_back(PhotometricPlane{c[plane], {}});
        for (size_t j = 0; j < angle_count; ++j)
            p.candela.push_back(fields.candela(scale, fmt::format("intensity {} of {} in the plane C {}°",
                                                                  j + 1, angle_count, p.longitude)));
    }
    mirror_planes(planes, symmetry == 2 || symmetry == 4, symmetry == 3 || symmetry == 4);
    set_table(d, planes);
    compare_flux(d, lamp_flux * output / 100, "lamps and output ratio make");
    return d;
}

std::string ldt_text(const IntensityDistribution& given, const PhotometricLabels& labels) {
    const IntensityDistribution d = in_c_planes(given);
    const bool axial = d.planes.size() == 1;
    const size_t planes = axial ? 1 : d.planes.size() - 1;  // the last one closes the circle
    std::string text;
    const auto line = [&](const auto& value) { text += fmt::format("{}\r\n", value); };
    const auto number = [&](double value) { text += fmt::format("{:.9g}\r\n", value); };
    // Of evenly spaced angles, else 0.
    const auto distance = [](const std::vector<double>& angles) {
        if (angles.size() < 2) return 0.0;
        const double step = angles[1] - angles[0];
        for (size_t i = 1; i < angles.size(); ++i)
            if (std::abs(angles[i] - angles[i - 1] - step) > 1e-6) return 0.0;
        return step;
    };
    const double flux = d.flux();
    line(printable(labels.manufacturer)), line(axial ? 1 : 3), line(axial ? 1 : 0), line(planes);
    number(distance(d.planes)), line(d.angles.size()), number(distance(d.angles));
    line(printable(labels.laboratory.empty() ? "simulation" : labels.laboratory)),
        line(printable(labels.luminaire));
    line(printable(labels.number)), line(""), line(printable(labels.date));
    const LuminousOpening& o = d.opening;
    const glm::dvec3 mm = o.size * 1000.0;
    const bool round = o.kind == Kind::disk || o.kind == Kind::cylinder || o.kind == Kind::sphere;
    for (int twice = 0; twice < 2; ++twice) {  // the luminaire is as large as its luminous area
        number(mm.y), number(round ? 0 : mm.x);
        if (twice == 0) number(mm.z);
    }
    for (int side = 0; side < 4; ++side) number(mm.z);
    number(flux > 0 ? 100 * downward_flux(d) / flux : 0), line(100), line(1), line(0), line(1);
    line(-1), line(""), number(flux), line(""), line(""), number(d.watts);
    for (int i = 0; i < 10; ++i) line(0);
    for (size_t p = 0; p < planes; ++p) number(d.planes[p]);
    for (const double angle : d.angles) number(angle);
    for (size_t i = 0; i < planes * d.angles.size(); ++i) number(flux > 0 ? d.candela[i] / flux * 1000 : 0);
    return text;
}

void write_ldt(const std::filesystem::path& file, const IntensityDistribution& d,
               const PhotometricLabels& labels) {
    write_atomically(file, std::string_view(ldt_text(d, labels)));
}

}  // namespace etendue
