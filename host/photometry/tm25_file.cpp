// Ray files of IES TM-25 (version 2013), read and written; checked against files of LightTools, and with the
// layout of TM25RaySetTools (J. Muschaweck), which names the sections of the standard.
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/image/atomic_file.h"
#include "host/photometry/ray_reader.h"

namespace etendue {
namespace {

constexpr int32_t version = 2013;
constexpr uint64_t flags_at = 256, texts_at = 288, text_bytes = 4000, header_bytes = 36288;
constexpr uint64_t column_name_bytes = 512, pad = 32;
constexpr double unit = 1;  // mm

// The columns of a ray that a file may have, in the order of their flags.
enum Item { position, direction, watts, wavelength, lumens, stokes, tristimulus, spectrum_index, item_count };
enum SpectrumKind { no_spectrum, one_wavelength, wavelength_a_ray, one_table, table_a_ray };

// A flux or wavelength of the header; 0 where it is unknown, which is 0, not a number, or the bytes of NaN in
// the wrong order.
double known(float value) { return value > 1e-30f && value < 1e30f ? value : 0.0; }

uint64_t padded(uint64_t bytes) { return (bytes + pad - 1) / pad * pad; }

// UTF-32LE up to its first 0, as UTF-8.
std::string text_at(RayReader& in, uint64_t byte, uint64_t bytes) {
    std::vector<uint32_t> points(bytes / 4);
    in.read(byte, std::as_writable_bytes(std::span(points)));
    std::string text;
    for (const uint32_t c : points) {
        if (c == 0) break;
        const uint32_t p = c < 0x110000 && !(c >= 0xD800 && c < 0xE000) ? c : 0xFFFD;
        if (p < 0x80) {
            text += char(p);
        } else if (p < 0x800) {
            text += {char(0xC0 | p >> 6), char(0x80 | (p & 63))};
        } else if (p < 0x10000) {
            text += {char(0xE0 | p >> 12), char(0x80 | (p >> 6 & 63)), char(0x80 | (p & 63))};
        } else {
            text += {char(0xF0 | p >> 18), char(0x80 | (p >> 12 & 63)), char(0x80 | (p >> 6 & 63)),
                     char(0x80 | (p & 63))};
        }
    }
    return text;
}

// Sound UTF-8 to code points, cut to `most`.
std::vector<uint32_t> code_points(const std::string& text, size_t most) {
    std::vector<uint32_t> points;
    for (size_t i = 0; i < text.size() && points.size() < most;) {
        const auto c = uint8_t(text[i]);
        const int more = c < 0x80 ? 0 : c < 0xE0 ? 1 : c < 0xF0 ? 2 : 3;
        uint32_t p = more == 0 ? c : c & (0x3Fu >> more);
        for (int k = 1; k <= more && i + k < text.size(); ++k) p = p << 6 | (uint8_t(text[i + k]) & 63);
        points.push_back(p);
        i += size_t(more) + 1;
    }
    return points;
}

struct Layout {
    bool has[item_count];
    int32_t spectrum, tables, extras, text;
    uint64_t columns() const {
        return 6 + has[watts] + has[wavelength] + has[lumens] + 6 * has[stokes] + 2 * has[tristimulus] +
               has[spectrum_index] + uint64_t(extras);
    }
};

Layout read_layout(RayReader& in) {
    static const char* const names[] = {"position",      "direction", "radiant flux", "wavelength",
                                        "luminous flux", "Stokes",    "tristimulus",  "spectrum index"};
    Layout layout;
    if (const auto v = in.number<int32_t>(4); v != version) in.fail(4, "version {}; must be {}", v, version);
    in.choice(56, "where rays start", 0, 7);
    layout.spectrum = in.choice(60, "the kind of spectrum", no_spectrum, table_a_ray);
    layout.tables = in.choice(76, "the number of spectral tables", 0, 100'000);
    layout.extras = in.choice(80, "the number of additional columns", 0, 1000);
    layout.text = in.choice(84, "the size of the additional text", 0, 1 << 30);
    if (layout.text % int32_t(pad) != 0)
        in.fail(84, "{} bytes of additional text; must be a multiple of {}", layout.text, pad);
    for (int i = 0; i < item_count; ++i)
        layout.has[i] =
            in.choice(flags_at + 4 * uint64_t(i), fmt::format("the flag of {}", names[i]).c_str(), 0, 1) == 1;
    const auto require = [&](bool holds, int item, const char* what) {
        if (!holds) in.fail(flags_at + 4 * uint64_t(item), "{}", what);
    };
    const bool* has = layout.has;
    require(has[position], position, "rays have no positions; must have them");
    require(has[direction], direction, "rays have no directions; must have them");
    require(has[watts] || has[lumens], watts, "rays have no flux; must have a radiant or a luminous one");
    require(has[watts] || !has[stokes], watts, "rays have Stokes parameters; must have a radiant flux, too");
    require(has[wavelength] == (layout.spectrum == wavelength_a_ray), wavelength,
            "a wavelength of each ray must go with spectra of kind 2");
    require(has[spectrum_index] == (layout.spectrum == table_a_ray), spectrum_index,
            "an index of each ray must go with spectra of kind 4");
    require(has[watts] || (!has[wavelength] && !has[spectrum_index]), watts,
            "rays have spectra; must have a radiant flux, too");
    require(!has[tristimulus] || (has[lumens] && layout.spectrum == no_spectrum), tristimulus,
            "rays have tristimulus values; must have a luminous flux and no spectra");
    if ((layout.tables > 0) != (layout.spectrum >= one_table) ||
        (layout.spectrum == one_table && layout.tables != 1))
        in.fail(76, "{} spectral tables; must be 1 with spectra of kind 3, some with kind 4, else none",
                layout.tables);
    return layout;
}

// Returns where they end.
uint64_t read_tables(RayReader& in, const Layout& layout, RayFile& file) {
    uint64_t at = header_bytes;
    for (int32_t i = 0; i < layout.tables; ++i) {
        const int32_t points = in.choice(at, "the number of points of a spectral table", 1, 1'000'000);
        if (in.size - at < 4 + 8 * uint64_t(points))
            in.fail(at, "a spectral table of {} points; the file ends before", points);
        std::vector<glm::vec2> pairs(static_cast<size_t>(points));
        in.read(at + 4, std::as_writable_bytes(std::span(pairs)));
        RaySpectrum& table = file.spectra.emplace_back();
        double sum = 0;
        for (size_t k = 0; k < pairs.size(); ++k) {
            const glm::vec2 p = pairs[k];
            if (!(p.x >= 1 && p.x <= 1e7f && (k == 0 || p.x > pairs[k - 1].x)))
                in.fail(at + 4 + 8 * k,
                        "the wavelength {:.6g} nm of a spectral table; must be in [1, 1e7], and rise", p.x);
            if (!(p.y >= 0 && p.y <= 1e30f))
                in.fail(at + 8 + 8 * k,
                        "the weight {:.6g} of a spectral table; must be a number in [0, 1e30]", p.y);
            table.nm.push_back(p.x), table.weights.push_back(p.y);
            sum += p.y;
        }
        if (!(sum > 0)) in.fail(at, "a spectral table that is 0; must have a weight above 0");
        at += 4 + 8 * uint64_t(points);
    }
    return header_bytes + padded(at - header_bytes);
}

// The rays, at the end of the file.
void read_rays(RayReader& in, const Layout& layout, uint64_t start, RayFile& file) {
    const auto count = in.number<uint64_t>(20);
    const uint64_t bytes = layout.columns() * sizeof(float);
    const uint64_t body = start <= in.size ? in.size - start : 0;
    if (start > in.size || count != body / bytes || body % bytes != 0)
        in.fail(20, "{} rays of {} bytes from byte {} on; the file has {} bytes there", count, bytes, start,
                body);
    RayCollector rays(file, in.name, unit);
    rays.reserve(count, "byte 20");
    const bool* has = layout.has;
    file.unit = has[watts] ? RayFile::Unit::watt : RayFile::Unit::lumen;
    if (has[watts] && has[lumens]) file.lumens.reserve(count);
    if (has[wavelength]) file.wavelengths.reserve(count);
    if (has[tristimulus]) file.tristimulus.reserve(count);
    if (has[spectrum_index]) file.spectrum_of.reserve(count);
    if (has[stokes]) file.polarization.reserve(count);
    in.for_each_ray(start, count, uint32_t(layout.columns()), [&](std::span<const float> r) {
        size_t at = 6;
        const auto next = [&] { return r[at++]; };
        const float phi = has[watts] ? next() : 0;
        const float nm = has[wavelength] ? next() : 0;
        const float phi_v = has[lumens] ? next() : 0;
        rays.add(r.first(3), r.subspan(3, 3), has[watts] ? phi : phi_v);
        if (has[wavelength]) rays.add_wavelength(nm);
        if (has[watts] && has[lumens]) rays.add_lumens(phi_v);
        if (has[stokes]) {
            rays.add_polarization({{r[at], r[at + 1], r[at + 2]}, {r[at + 3], r[at + 4], r[at + 5]}});
            at += 6;
        }
        if (has[tristimulus]) {
            rays.add_tristimulus({r[at], r[at + 1]});
            at += 2;
        }
        if (has[spectrum_index]) {
            const float index = next();
            if (!(index >= 1 && index <= float(layout.tables) && index == std::floor(index)))
                in.fail(start + (file.rays.size() - 1) * bytes,
                        "ray {} has the spectral table {:.6g}; must be from 1 to {}", file.rays.size(), index,
                        layout.tables);
            file.spectrum_of.push_back(uint32_t(index) - 1);
        }
    });
    rays.finish();
}

}  // namespace

bool looks_like_tm25(RayReader& in) {
    char mark[4] = {};
    if (in.size >= 4) in.read(0, std::as_writable_bytes(std::span(mark)));
    return std::string_view(mark, 4) == "TM25";
}

RayFile read_tm25(RayReader& in) {
    RayFile file;
    file.format = "TM-25";
    const Layout layout = read_layout(in);
    file.stated_lumens = known(in.number<float>(12));
    file.stated_watts = known(in.number<float>(16));
    for (size_t i = 0; i < file.texts.size(); ++i)
        file.texts[i] = text_at(in, texts_at + text_bytes * i, text_bytes);
    const uint64_t tables_end = read_tables(in, layout, file);
    read_rays(in, layout, tables_end + column_name_bytes * uint64_t(layout.extras) + uint64_t(layout.text),
              file);
    if (layout.spectrum == one_wavelength) {
        const auto nm = in.number<float>(64);
        if (!(nm >= 1 && nm <= 1e7f))
            in.fail(64, "the wavelength of all rays is {:.6g} nm; must be a number in [1, 1e7]", nm);
        file.wavelengths.assign(file.rays.size(), nm);
    }
    return file;
}

void write_tm25(const std::filesystem::path& path, const RayFile& file, const std::string& date) {
    constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    const bool in_watts = file.unit == RayFile::Unit::watt;
    const bool has_tables = in_watts && !file.spectra.empty(),
               has_index = has_tables && !file.spectrum_of.empty();
    std::vector<std::byte> head(header_bytes);
    const auto put = [&](uint64_t byte, auto value) {
        std::memcpy(head.data() + byte, &value, sizeof value);
    };
    std::memcpy(head.data(), "TM25", 4);
    put(4, version);
    double lumens_sum = 0;
    for (const float v : file.lumens) lumens_sum += v;
    const double flux = file.flux(),
                 stated = in_watts && !file.lumens.empty() ? lumens_sum : file.stated_lumens;
    put(12, in_watts ? (stated > 0 ? float(stated) : unknown) : float(flux));
    put(16, in_watts ? float(flux) : unknown);
    put(20, uint64_t(file.rays.size()));
    std::memcpy(head.data() + 28, date.data(), std::min<size_t>(date.size(), 27));
    const bool has_wavelengths = in_watts && !file.wavelengths.empty();
    const bool has_tristimulus = !in_watts && !file.tristimulus.empty();
    put(60, int32_t(has_index         ? table_a_ray
                    : has_tables      ? one_table
                    : has_wavelengths ? wavelength_a_ray
                                      : no_spectrum));
    const auto range = std::minmax_element(file.wavelengths.begin(), file.wavelengths.end());
    put(64, unknown);
    put(68, has_wavelengths ? *range.first : unknown);
    put(72, has_wavelengths ? *range.second : unknown);
    put(76, int32_t(has_tables ? file.spectra.size() : 0));
    const bool flags[item_count] = {true,
                                    true,
                                    in_watts,
                                    has_wavelengths,
                                    !in_watts || !file.lumens.empty(),
                                    in_watts && !file.polarization.empty(),
                                    has_tristimulus,
                                    has_index};
    for (int i = 0; i < item_count; ++i) put(flags_at + 4 * uint64_t(i), int32_t(flags[i]));
    for (size_t i = 0; i < file.texts.size(); ++i) {
        const std::vector<uint32_t> points = code_points(file.texts[i], text_bytes / 4 - 1);
        std::memcpy(head.data() + texts_at + text_bytes * i, points.data(), 4 * points.size());
    }
    for (const RaySpectrum& table : has_tables ? file.spectra : std::vector<RaySpectrum>()) {
        const auto add = [&](auto value) {
            const auto bytes = std::as_bytes(std::span(&value, 1));
            head.insert(head.end(), bytes.begin(), bytes.end());
        };
        add(int32_t(table.nm.size()));
        for (size_t k = 0; k < table.nm.size(); ++k) add(table.nm[k]), add(table.weights[k]);
    }
    head.resize(header_bytes + padded(head.size() - header_bytes));
    std::vector<float> body;
    for (size_t i = 0; i < file.rays.size(); ++i) {
        const SourceRay& r = file.rays[i];
        for (int k = 0; k < 3; ++k) body.push_back(r.position[k]);
        for (int k = 0; k < 3; ++k) body.push_back(r.direction[k]);
        if (in_watts) body.push_back(r.flux);
        if (has_wavelengths) body.push_back(file.wavelengths[i]);
        if (!in_watts)
            body.push_back(r.flux);
        else if (!file.lumens.empty())
            body.push_back(file.lumens[i]);
        if (in_watts && !file.polarization.empty()) {
            const RayPolarization& p = file.polarization[i];
            body.insert(body.end(), {p.stokes.x, p.stokes.y, p.stokes.z, p.axis.x, p.axis.y, p.axis.z});
        }
        if (has_tristimulus) body.insert(body.end(), {file.tristimulus[i].x, file.tristimulus[i].y});
        if (has_index) body.push_back(float(file.spectrum_of[i] + 1));
    }
    write_atomically(path, {std::span<const std::byte>(head), std::as_bytes(std::span(body))});
}

}  // namespace etendue
