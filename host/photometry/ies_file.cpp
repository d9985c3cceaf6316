#include "host/photometry/ies_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/image/atomic_file.h"
#include "host/photometry/photometric_text.h"

namespace etendue {
namespace {

using Type = IntensityDistribution::Type;
using Kind = LuminousOpening::Kind;

std::string upper(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    return result;
}

// The edition that the first line names. Without such a line it is 1986; an unknown one is taken as the
// newest.
int edition(const std::string& first_line) {
    const std::string line = upper(first_line);
    if (!line.starts_with("IES")) return 1986;
    for (const int year : {1986, 1991, 1995, 2002})
        if (line.find(std::to_string(year)) != line.npos) return year;
    return line.starts_with("IESNA91") ? 1991 : 2019;
}

// What stands behind the '=' of a line "TILT = …"; null where it is no such line.
bool tilt_line(const std::string& line, std::string& value) {
    if (!upper(line.substr(0, 4)).starts_with("TILT")) return false;
    const std::string_view rest = trimmed(std::string_view(line).substr(4));
    if (!rest.starts_with('=')) return false;
    value = trimmed(rest.substr(1));
    return true;
}

// The numbers of a file from some line on. They may be parted by blanks, commas and ends of lines anywhere.
class Numbers {
  public:
    Numbers(const PhotometricText& text, size_t line) : text_(text), line_(line) {}

    double next(const std::string& what) {
        const std::string_view separators = " \t,";
        for (;; ++line_, at_ = 0) {
            if (line_ >= text_.lines.size())
                text_.fail(text_.lines.empty() ? 0 : text_.lines.size() - 1, "the file ends before {}", what);
            at_ = std::min(text_.lines[line_].find_first_not_of(separators, at_), text_.lines[line_].size());
            if (at_ < text_.lines[line_].size()) break;
        }
        const std::string& line = text_.lines[line_];
        const size_t end = std::min(line.find_first_of(separators, at_), line.size());
        const std::string_view word = std::string_view(line).substr(at_, end - at_);
        at_ = end;
        return text_.number(line_, word, what);
    }
    double candela(double factor, const std::string& what) {
        const double value = factor * next(what);
        return text_.candela(line_, value, what);
    }
    size_t count(const std::string& what, size_t least, size_t most) {
        const double value = next(what);
        return text_.count(line_, value, what, least, most);
    }
    template <class... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        text_.fail(line_, format, std::forward<Args>(args)...);
    }

    // Degrees, rising, from `least` to `most`.
    std::vector<double> angles(const char* name, size_t count, double least, double most) {
        std::vector<double> angles;
        for (size_t i = 0; i < count; ++i) {
            const double a = next(fmt::format("{} angle {} of {}", name, i + 1, count));
            if (!(a >= least && a <= most))
                fail("{} angle {} is {}°; must be {} to {}", name, i + 1, a, least, most);
            if (i > 0 && !(a > angles.back()))
                fail("{} angle {} is {}°, after {}°; angles must rise", name, i + 1, a, angles.back());
            angles.push_back(a);
        }
        return angles;
    }

  private:
    const PhotometricText& text_;
    size_t line_, at_ = 0;
};

// The rules of signs: round ones are negative. `old`: of 1986 to 1995, where one number may stand for two.
LuminousOpening opening(double width, double length, double height, bool old) {
    const auto is_negative = [](double v) { return v < 0; };
    glm::dvec3 s(length, width, height);  // C0 is along the length
    LuminousOpening o;
    const int negative = is_negative(width) + is_negative(length) + is_negative(height);
    const bool one_width = width < 0 && length == 0;
    if (old && one_width && height < 0) {
        o.kind = Kind::sphere, s.x = width;
    } else if (negative == 3) {
        o.kind = Kind::sphere;
    } else if (negative == 2) {  // round about the third
        o.axis = length >= 0 ? 0 : width >= 0 ? 1 : 2;
        o.kind = s[o.axis] > 0 ? Kind::cylinder : Kind::disk;
    } else if (one_width) {
        o.kind = height > 0 ? Kind::cylinder : Kind::disk, s.x = width;
    } else if (height < 0) {  // a tube
        o.kind = Kind::cylinder;
        o.axis = length > 0 ? 0 : 1;
        s[1 - o.axis] = height;
    } else if (negative == 1) {  // the other one may lie along either
        o.kind = height > 0 ? Kind::cylinder : Kind::ellipse;
    } else if (const int zeros = (width == 0) + (length == 0) + (height == 0); zeros == 1) {
        o.kind = Kind::rectangle;
        o.axis = length == 0 ? 0 : width == 0 ? 1 : 2;
    } else if (zeros == 0) {
        o.kind = Kind::box;
    }
    o.size = o.kind == Kind::point ? glm::dvec3(0) : glm::abs(s);
    if (o.kind == Kind::disk && o.size[o.axis == 0] != o.size[o.axis == 2 ? 1 : 2]) o.kind = Kind::ellipse;
    return o;
}

// The horizontal angles of type C say what symmetry the lamp has.
void complete_circle(std::vector<PhotometricPlane>& planes, const Numbers& numbers,
                     IntensityDistribution& d) {
    if (planes.size() == 1) return;
    const double first = planes.front().longitude, last = planes.back().longitude, span = last - first;
    const auto is = [&](double a, double b) {
        return std::abs(first - a) < 1e-3 && std::abs(last - b) < 1e-3;
    };
    double step = 0;
    for (size_t i = 1; i < planes.size(); ++i)
        step = std::max(step, planes[i].longitude - planes[i - 1].longitude);
    if (is(0, 90)) {
        mirror_planes(planes, true, true);
    } else if (is(0, 180) || is(180, 360) || is(-180, 0)) {
        mirror_planes(planes, true, false);
    } else if (is(90, 270) || is(-90, 90)) {
        mirror_planes(planes, false, true);
    } else if (std::abs(span - 360) < 1e-3 && planes[planes.size() - 2].longitude < first + 360) {
        planes.back().longitude = first + 360;
    } else if (span < 360 && 360 - span <= 1.5 * step) {
        d.warnings.push_back(fmt::format("the horizontal angles end at {}°: the plane {}° stands at {}°, too",
                                         last, first, first + 360));
        mirror_planes(planes, false, false);
    } else {
        numbers.fail(
            "horizontal angles go from {}° to {}°; must be 0 alone, 0 to 90, 0 to 180, 90 to 270 or once "
            "around",
            first, last);
    }
}

// Types B and A: horizontal angles from 0 on are mirrored.
void mirror_h(std::vector<double>& h, std::vector<std::vector<double>>& of_h) {
    if (h.empty() || std::abs(h[0]) > 1e-6 || h.size() == 1) return;
    std::vector<double> angles;
    std::vector<std::vector<double>> values;
    for (size_t i = h.size() - 1; i > 0; --i) angles.push_back(-h[i]), values.push_back(of_h[i]);
    h.insert(h.begin(), angles.begin(), angles.end());
    of_h.insert(of_h.begin(), values.begin(), values.end());
}

// How the lamp's flux changes where the luminaire is tilted. Returns the factor for one that is not: which
// way a luminaire was measured the file does not say.
double read_tilt(Numbers& numbers, IntensityDistribution& d) {
    const size_t geometry = numbers.count("the lamp's geometry of TILT", 1, 3);
    const size_t count = numbers.count("the number of angles of TILT", 1, 1000);
    const std::vector<double> angles = numbers.angles("TILT", count, 0, 180);
    std::vector<double> factors;
    for (size_t i = 0; i < count; ++i) {
        factors.push_back(numbers.next("a factor of TILT"));
        if (!(factors[i] >= 0 && factors[i] <= 10))
            numbers.fail("factor {} of TILT is {}; must be 0 to 10", i + 1, factors[i]);
    }
    const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
    if (*least == *most && *most == 1) return 1;
    d.warnings.push_back(
        fmt::format("TILT: of a lamp that {} the luminaire would send {:g} to {:g} of its light at {:g}° to "
                    "{:g}°; taken as "
                    "untilted, {:g}",
                    geometry == 1   ? "burns base up or down"
                    : geometry == 2 ? "stays horizontal"
                                    : "lies horizontally and is tilted with it",
                    *least, *most, angles.front(), angles.back(), factors.front()));
    return factors.front();
}

// The same from a file beside the photometric one.
double read_tilt_file(const std::string& name, const std::optional<std::filesystem::path>& folder,
                      IntensityDistribution& d) {
    const std::filesystem::path plain = std::filesystem::path(name).filename();
    std::error_code failure;
    if (!folder || plain != name || !std::filesystem::is_regular_file(*folder / plain, failure)) {
        d.warnings.push_back(
            fmt::format("TILT={}: no such file beside it; the lamp is taken as untilted", name));
        return 1;
    }
    const PhotometricText text =
        photometric_text((*folder / plain).string(), read_photometric_bytes(*folder / plain));
    Numbers numbers(text, 0);
    return read_tilt(numbers, d);
}

struct Header {
    double lamps, lumens, multiplier, factor, watts;
    size_t v, h, type;
    double unit;
};

Header read_header(Numbers& numbers, int year, IntensityDistribution& d) {
    Header header;
    header.lamps = numbers.next("the number of lamps");
    header.lumens = numbers.next("the lumens per lamp");
    header.multiplier = numbers.next("the multiplier");
    header.v = numbers.count("the number of vertical angles", 2, max_photometric_angles);
    header.h = numbers.count("the number of horizontal angles", 1, max_photometric_angles);
    header.type = numbers.count("the photometric type", 1, 3);
    header.unit = numbers.count("the unit of length", 1, 2) == 1 ? 0.3048 : 1.0;
    if (header.v * header.h > max_photometric_values)
        numbers.fail("{} x {} intensities; a table has at most {}", header.v, header.h,
                     max_photometric_values);
    const double width = numbers.next("the width") * header.unit,
                 length = numbers.next("the length") * header.unit,
                 height = numbers.next("the height") * header.unit;
    d.opening = opening(width, length, height, year <= 1995);
    header.factor = header.multiplier;
    // The second one was the ballast-lamp factor, is 1 in 2002, and no factor in 2019.
    for (const bool counts : {true, year <= 2002}) {
        const double factor = numbers.next("the ballast factor");
        if (counts && factor == 0) d.warnings.emplace_back("a ballast factor is 0: taken as 1");
        if (counts && factor != 0) header.factor *= factor;
    }
    if (!(header.factor >= 0)) numbers.fail("the factors make {}; must be at least 0", header.factor);
    header.watts = numbers.next("the input watts");
    return header;
}

}  // namespace

IntensityDistribution read_ies(const std::filesystem::path& file) {
    return parse_ies(file.string(), read_photometric_bytes(file), file.parent_path());
}

IntensityDistribution parse_ies(const std::string& name, std::string bytes,
                                const std::optional<std::filesystem::path>& folder) {
    const PhotometricText text = photometric_text(name, std::move(bytes));
    IntensityDistribution d;
    std::string tilt;
    size_t line = 0;
    while (line < text.lines.size() && !tilt_line(text.lines[line], tilt)) ++line;
    if (line == text.lines.size())
        fail_input("{}: not a photometric file of the IES: no line begins with TILT=", text.file);
    const int year = edition(text.lines[0]);
    d.description.assign(text.lines.begin() + (line > 0 && year != 1986 ? 1 : 0), text.lines.begin() + line);
    Numbers numbers(text, line + 1);
    const std::string how = upper(tilt);
    double tilt_factor = 1;
    if (how == "INCLUDE")
        tilt_factor = read_tilt(numbers, d);
    else if (how != "NONE")
        tilt_factor = read_tilt_file(tilt, folder, d);

    Header header = read_header(numbers, year, d);
    header.factor *= tilt_factor;
    d.watts = header.watts;
    const char* const types[] = {"", "C", "B", "A"};
    d.type = header.type == 1 ? Type::c : header.type == 2 ? Type::b : Type::a;
    const bool is_c = d.type == Type::c;
    std::vector<double> v = numbers.angles("vertical", header.v, is_c ? 0 : -90, is_c ? 180 : 90);
    std::vector<double> h = numbers.angles("horizontal", header.h,
                                           is_c                ? -360
                                           : d.type == Type::b ? -90
                                                               : -180,
                                           is_c                ? 720
                                           : d.type == Type::b ? 90
                                                               : 180);
    std::vector<std::vector<double>> of_h;  // of each H, of each V
    for (size_t i = 0; i < h.size(); ++i) {
        std::vector<double>& values = of_h.emplace_back();
        for (size_t j = 0; j < v.size(); ++j)
            values.push_back(numbers.candela(
                header.factor,
                fmt::format("intensity {} of {} at the horizontal angle {}°", j + 1, v.size(), h[i])));
    }
    std::vector<PhotometricPlane> planes;
    if (is_c) {
        d.angles = v;
        for (size_t i = 0; i < h.size(); ++i) planes.push_back({h[i], std::move(of_h[i])});
        complete_circle(planes, numbers, d);
    } else {
        mirror_h(h, of_h);
        if (h.size() < 2) numbers.fail("type {} has one horizontal angle; must have two", types[header.type]);
        const bool by_h = d.type == Type::a;  // longitudes are H
        const std::vector<double>&longitudes = by_h ? h : v, &latitudes = by_h ? v : h;
        for (size_t k = latitudes.size(); k-- > 0;) d.angles.push_back(90 - latitudes[k]);
        for (size_t p = 0; p < longitudes.size(); ++p) {
            PhotometricPlane& plane = planes.emplace_back(PhotometricPlane{longitudes[p], {}});
            for (size_t k = latitudes.size(); k-- > 0;)
                plane.candela.push_back(by_h ? of_h[p][k] : of_h[k][p]);
        }
    }
    set_table(d, planes);
    compare_flux(d, header.lumens > 0 ? header.lamps * header.lumens : 0, "its lamps have");
    return d;
}

std::string ies_text(const IntensityDistribution& given, const PhotometricLabels& labels) {
    const IntensityDistribution d = in_c_planes(given);
    std::string text = "IES:LM-63-2019\r\n";
    const auto label = [&](const char* name, const std::string& value) {
        text += fmt::format("[{}] {}\r\n", name, printable(value));
    };
    label("TEST", labels.number.empty() ? "simulation" : labels.number);
    label("TESTLAB", labels.laboratory.empty() ? "etendue" : labels.laboratory);
    label("ISSUEDATE", labels.date);
    label("MANUFAC", labels.manufacturer);
    if (!labels.luminaire.empty()) label("LUMINAIRE", labels.luminaire);

    const LuminousOpening& o = d.opening;
    glm::dvec3 s = o.size;
    const bool round = o.kind == Kind::disk || o.kind == Kind::ellipse || o.kind == Kind::cylinder;
    for (int axis = 0; axis < 3; ++axis)
        if (o.kind == Kind::sphere || (round && axis != o.axis)) s[axis] = -s[axis];
    text += fmt::format("TILT=NONE\r\n1 -1 1 {} {} 1 2 {:.9g} {:.9g} {:.9g}\r\n1 1.00010 {:.9g}\r\n",
                        d.angles.size(), d.planes.size(), s.y, s.x, s.z, d.watts);
    const auto row = [&](const double* values, size_t count) {
        for (size_t i = 0; i < count; ++i)
            text += fmt::format("{:.9g}{}", values[i], i + 1 == count || i % 10 == 9 ? "\r\n" : " ");
    };
    row(d.angles.data(), d.angles.size());
    row(d.planes.data(), d.planes.size());
    for (size_t p = 0; p < d.planes.size(); ++p) row(&d.candela[p * d.angles.size()], d.angles.size());
    return text;
}

void write_ies(const std::filesystem::path& file, const IntensityDistribution& d,
               const PhotometricLabels& labels) {
    write_atomically(file, std::string_view(ies_text(d, labels)));
}

}  // namespace etendue
