#include "host/photometry/ray_file.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/photometry/ray_reader.h"

namespace etendue {

static_assert(std::endian::native == std::endian::little);

constexpr float most_flux = 1e15f;  // W or lm, of a ray

double RayFile::flux() const {
    double sum = 0;
    for (const SourceRay& ray : rays) sum += ray.flux;
    return sum;
}

RayReader::RayReader(const std::filesystem::path& file) : name(file.string()), in_(file, std::ios::binary) {
    std::error_code error;
    size = std::filesystem::file_size(file, error);
    if (!in_ || error) fail_input("{}: cannot be read", name);
}

void RayReader::read(uint64_t byte, std::span<std::byte> bytes) {
    if (byte > size || bytes.size() > size - byte)
        fail(byte, "the file ends after {} bytes; must go on for {} more", size, bytes.size());
    in_.seekg(std::streamoff(byte));
    in_.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (!in_) fail(byte, "cannot be read");
}

int32_t RayReader::choice(uint64_t byte, const char* what, int32_t least, int32_t most) {
    const auto value = number<int32_t>(byte);
    if (value < least || value > most)
        fail(byte, "{} is {}; must be from {} to {}", what, value, least, most);
    return value;
}

void RayReader::for_each_ray(uint64_t byte, uint64_t count, uint32_t columns,
                             const std::function<void(std::span<const float>)>& take) {
    constexpr uint64_t at_once = 1 << 14;
    std::vector<float> numbers(columns * std::min(count, at_once));
    for (uint64_t i = 0; i < count; i += at_once) {
        const std::span<float> part = std::span(numbers).first(columns * std::min(count - i, at_once));
        read(byte + i * columns * sizeof(float), std::as_writable_bytes(part));
        for (size_t at = 0; at < part.size(); at += columns) take(part.subspan(at, columns));
    }
}

void RayCollector::reserve(uint64_t count, const std::string& where) {
    if (count < 1 || count > most_rays)
        fail_input("{}: {}: {} rays; must be from 1 to {}", name_, where, count, most_rays);
    file_.rays.reserve(count);
}

void RayCollector::add(std::span<const float> position, std::span<const float> direction, float flux) {
    const glm::dvec3 p(position[0], position[1], position[2]), d(direction[0], direction[1], direction[2]);
    const glm::dvec3 place = p * unit_;
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(place[i]) <= farthest_ray))
            fail(file_.rays.size() + 1, "starts at ({:.6g}, {:.6g}, {:.6g}) mm; must be at most {:g} mm away",
                 place.x, place.y, place.z, farthest_ray);
    const double length = glm::length(d);
    if (!(length > 1e-6 && length < 1e6))
        fail(file_.rays.size() + 1, "has the direction ({:.6g}, {:.6g}, {:.6g}); must be a unit vector", d.x,
             d.y, d.z);
    if (!(flux >= 0 && flux <= most_flux))
        fail(file_.rays.size() + 1, "has a flux of {:.6g}; must be a number in [0, 1e15]", flux);
    turned_ += std::abs(length - 1) > 1e-3;
    // A unit vector to the rounding of floats stays what it is.
    const glm::dvec3 unit = std::abs(length - 1) > 1e-6 ? d / length : d;
    file_.rays.push_back({glm::vec3(place), glm::vec3(unit), flux});
}

void RayCollector::add_lumens(float lumens) {
    if (!(lumens >= 0 && lumens <= most_flux))
        fail(file_.rays.size(), "has {:.6g} lm; must be a number in [0, 1e15]", lumens);
    file_.lumens.push_back(lumens);
}

void RayCollector::add_wavelength(double nm) {
    if (!(nm >= 1 && nm <= 1e7))
        fail(file_.rays.size(), "has a wavelength of {:.6g} nm; must be a number in [1, 1e7]", nm);
    file_.wavelengths.push_back(float(nm));
}

void RayCollector::add_tristimulus(const glm::vec2& xz) {
    for (int i = 0; i < 2; ++i)
        if (!(std::abs(xz[i]) <= most_flux))
            fail(file_.rays.size(), "has the tristimulus value {:.6g}; must be a number in [-1e15, 1e15]",
                 xz[i]);
    file_.tristimulus.push_back(xz);
}

void RayCollector::add_polarization(const RayPolarization& p) {
    const glm::dvec3 s(p.stokes), axis(p.axis);
    if (!(glm::length(s) <= 1.001))
        fail(file_.rays.size(),
             "has the Stokes parameters ({:.6g}, {:.6g}, {:.6g}); must be parts of its flux, at most 1 "
             "together",
             s.x, s.y, s.z);
    const double across = glm::length(glm::cross(axis, glm::dvec3(file_.rays.back().direction)));
    if ((s.x != 0 || s.y != 0) && !(across > 1e-3 && across < 1e6))
        fail(file_.rays.size(), "has the axis of polarization ({:.6g}, {:.6g}, {:.6g}); must lie across it",
             axis.x, axis.y, axis.z);
    file_.polarization.push_back(p);
}

void RayCollector::finish() {
    if (!(file_.flux() > 0)) fail_input("{}: none of its {} rays carries any flux", name_, file_.rays.size());
    if (turned_ > 0)
        file_.warnings.push_back(fmt::format("{} of {} directions were no unit vectors: they are made such",
                                             turned_, file_.rays.size()));
    const double flux = file_.flux(),
                 stated = file_.unit == RayFile::Unit::watt ? file_.stated_watts : file_.stated_lumens;
    if (stated > 0 && std::abs(flux / stated - 1) > 0.03)
        file_.warnings.push_back(
            fmt::format("its rays carry {:.6g} {}, the header states {:.6g}: the rays count", flux,
                        file_.unit == RayFile::Unit::watt ? "W" : "lm", stated));
}

RayFile read_ray_file(const std::filesystem::path& file) {
    RayReader in(file);
    if (looks_like_tm25(in)) return read_tm25(in);
    if (looks_like_lighttools(in)) return read_lighttools(in);
    if (looks_like_zemax(in)) return read_zemax(in);
    if (looks_like_zemax_text(in)) return read_zemax_text(in);
    if (looks_like_speos(in)) return read_speos(in);
    in.fail(0,
            "no ray file begins so; allowed: TM-25 ('TM25'), LightTools ('LTRF'), Zemax (1010 or 8675309, or "
            "lines of "
            "numbers), Speos (28 bytes, then rays of 8 numbers)");
}

}  // namespace etendue
