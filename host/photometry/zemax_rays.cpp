// Ray files of Zemax OpticStudio (.dat, .sdf), binary and as text, as its manual describes them ("Source
// File").
#include <algorithm>
#include <charconv>
#include <cmath>

#include "host/photometry/ray_reader.h"

namespace etendue {
namespace {

constexpr double mm_of_unit[] = {1000, 25.4, 10, 304.8, 1};
constexpr uint64_t header_bytes = 208;

// The longest line of a text that is one.
constexpr size_t most_characters = 4096;

bool is_text(std::span<const char> bytes) {
    return !bytes.empty() && std::all_of(bytes.begin(), bytes.end(), [](char c) {
        return (c >= '0' && c <= '9') || std::string_view("+-.eE ,\t\r\n").find(c) != std::string_view::npos;
    });
}

}  // namespace

bool looks_like_zemax(RayReader& in) {
    if (in.size < 4) return false;
    const auto mark = in.number<int32_t>(0);
    return mark == 1010 || mark == 8675309;
}

bool looks_like_zemax_text(RayReader& in) {
    std::vector<char> start(std::min<uint64_t>(in.size, 256));
    in.read(0, std::as_writable_bytes(std::span(start)));
    return is_text(start);
}

// Of the header only the number of rays, the unit, the layout and the kind of flux are used, as by Zemax.
RayFile read_zemax(RayReader& in) {
    RayFile file;
    file.format = "Zemax";
    const uint64_t count = in.number<uint32_t>(4);
    const int32_t unit = in.choice(136, "the unit of length", 0, 4), layout = in.number<int32_t>(192),
                  kind = in.choice(196, "the kind of flux", 0, 2);
    if (layout != 0 && layout != 2)
        in.fail(192, "the layout of rays is {}; must be 0 (flux) or 2 (with wavelengths)", layout);
    const uint32_t columns = layout == 0 ? 7 : 8;
    if (in.size - header_bytes != count * columns * sizeof(float))
        in.fail(4, "{} rays of {} bytes; {} bytes follow the header, must be {}", count,
                columns * sizeof(float), in.size - header_bytes, count * columns * sizeof(float));
    if (kind == 2)
        file.warnings.emplace_back("the kind of flux is 2, which the format does not have: taken as lumens");
    file.unit = kind == 0 ? RayFile::Unit::watt : RayFile::Unit::lumen;
    std::array<char, 100> name{};
    in.read(8, std::as_writable_bytes(std::span(name)));
    file.texts[0] = std::string(name.begin(), std::find(name.begin(), name.end(), '\0'));
    RayCollector rays(file, in.name, mm_of_unit[unit]);
    rays.reserve(count, "byte 4");
    if (columns == 8) file.wavelengths.reserve(count);
    in.for_each_ray(header_bytes, count, columns, [&](std::span<const float> r) {
        rays.add(r.first(3), r.subspan(3, 3), r[6]);
        if (columns == 8) rays.add_wavelength(1000.0 * r[7]);
    });
    rays.finish();
    return file;
}

// "rays unit", then a line a ray: position, direction, flux, and the wavelength in µm where it has one. What
// else stands in the first line does not count. Fluxes are watts: the text does not say.
RayFile read_zemax_text(RayReader& in) {
    RayFile file;
    file.format = "Zemax text";
    std::ifstream text(in.name, std::ios::binary);
    std::string line;
    uint64_t number = 0;
    const auto fail = [&](const std::string& what) { fail_input("{}: line {}: {}", in.name, number, what); };
    // The numbers of the next line that has some; none at the end.
    const auto next = [&] {
        std::vector<double> values;
        while (values.empty() && std::getline(text, line)) {
            ++number;
            if (line.size() > most_characters)
                fail(fmt::format("{} characters; must be at most {}", line.size(), most_characters));
            for (size_t at = 0; (at = line.find_first_not_of(" ,\t\r", at)) != line.npos;) {
                const size_t end = std::min(line.find_first_of(" ,\t\r", at), line.size());
                double value;
                const char* first = line.data() + at + (line[at] == '+');
                const auto [stop, error] = std::from_chars(first, line.data() + end, value);
                if (error != std::errc() || stop != line.data() + end)
                    fail(fmt::format("'{}'; must be a number",
                                     line.substr(at, std::min<size_t>(end - at, 40))));
                values.push_back(value);
                at = end;
            }
        }
        return values;
    };
    const std::vector<double> head = next();
    if (head.size() < 2 || head[0] != std::floor(head[0]) || !(head[0] >= 1 && head[0] <= double(most_rays)))
        fail(fmt::format("must be the number of rays, from 1 to {}, and the unit of length", most_rays));
    if (head[1] != std::floor(head[1]) || !(head[1] >= 0 && head[1] <= 4))
        fail(fmt::format("the unit of length is {}; must be from 0 to 4", head[1]));
    const auto count = uint64_t(head[0]);
    if (count > in.size / 14)  // seven digits and as many blanks
        fail(fmt::format("{} rays; {} bytes do not hold as many", count, in.size));
    RayCollector rays(file, in.name, mm_of_unit[int(head[1])]);
    rays.reserve(count, "line 1");
    size_t columns = 0;
    for (std::vector<double> values; !(values = next()).empty();) {
        if (columns == 0) columns = values.size();
        if (values.size() != columns || (columns != 7 && columns != 8))
            fail(fmt::format("{} numbers; must be 7 in every line, or 8 with the wavelength", values.size()));
        std::array<float, 8> r{};
        std::copy(values.begin(), values.end(), r.begin());
        if (file.rays.size() == count)
            fail(fmt::format("one ray more than the {} that the first line states", count));
        rays.add(std::span(r).first(3), std::span(r).subspan(3, 3), r[6]);
        if (columns == 8) rays.add_wavelength(1000.0 * values[7]);
    }
    if (file.rays.size() != count)
        fail(fmt::format("the file ends after {} rays; must have the {} of its first line", file.rays.size(),
                         count));
    rays.finish();
    return file;
}

}  // namespace etendue
