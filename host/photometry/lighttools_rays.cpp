// Ray files of LightTools (.ray): "LTRF", a header of 44 bytes (48 of version 3, which ends in a flag of
// polarization), rays (position, unless the file is one of the far field, direction, flux, wavelength if it
// has any), "LTRFEND". The header is as TM25RaySetTools (J. Muschaweck) describes it; where tristimulus
// values and Stokes vectors stand in a ray no public description tells.
#include "host/photometry/ray_reader.h"

namespace etendue {
namespace {

constexpr uint64_t end_bytes = 7;
constexpr double mm_of_unit[] = {1, 1, 10, 1000, 25.4, 304.8, 1e-3, 1e-6};

}  // namespace

bool looks_like_lighttools(RayReader& in) {
    char mark[4] = {};
    if (in.size >= 4) in.read(0, std::as_writable_bytes(std::span(mark)));
    return std::string_view(mark, 4) == "LTRF";
}

RayFile read_lighttools(RayReader& in) {
    RayFile file;
    file.format = "LightTools";
    const int32_t version = in.choice(4, "the version", 2, 3);
    const uint64_t header_bytes = version == 2 ? 44 : 48;
    if (version == 3 && in.number<uint32_t>(44) != 0)
        in.fail(44, "its rays have Stokes vectors, which are not read; must be 0 (none)");
    file.unit = in.choice(12, "the kind of data", 0, 1) == 0 ? RayFile::Unit::watt : RayFile::Unit::lumen;
    const bool is_far = in.choice(16, "the flag of the far field", 0, 1) == 1;
    const auto color = in.number<uint32_t>(20);
    if (color != 0 && color != 2)
        in.fail(20,
                "the kind of colour is {}; must be 0 (none) or 2 (wavelengths): tristimulus values (1) are "
                "not read",
                color);
    const int32_t unit = in.choice(24, "the unit of length", 0, 7);
    if (unit == 0)
        file.warnings.emplace_back("the unit of length is that of a system which is not told: taken as mm");
    const float origin[] = {in.number<float>(28), in.number<float>(32), in.number<float>(36)};
    if (!is_far && (origin[0] != 0 || origin[1] != 0 || origin[2] != 0))
        file.warnings.emplace_back("its origin is not 0: positions are taken as they stand");
    if (const auto flux = in.number<float>(40); flux > 1e-30f && flux < 1e30f)
        (file.unit == RayFile::Unit::watt ? file.stated_watts : file.stated_lumens) = flux;
    const uint32_t places = is_far ? 0 : 3, columns = places + (color == 0 ? 4 : 5),
                   bytes = columns * sizeof(float);
    const uint64_t body = in.size - std::min(in.size, header_bytes + end_bytes);
    if (body == 0 || body % bytes != 0)
        in.fail(header_bytes, "{} bytes of rays; must be a multiple of {}, and 'LTRFEND' behind them", body,
                bytes);
    char end[end_bytes];
    in.read(in.size - end_bytes, std::as_writable_bytes(std::span(end)));
    if (std::string_view(end, end_bytes) != "LTRFEND") in.fail(in.size - end_bytes, "must be 'LTRFEND'");
    RayCollector rays(file, in.name, mm_of_unit[unit]);
    rays.reserve(body / bytes, fmt::format("byte {}", header_bytes));
    if (color != 0) file.wavelengths.reserve(body / bytes);
    in.for_each_ray(header_bytes, body / bytes, columns, [&](std::span<const float> r) {
        const std::span<const float> rest = r.subspan(places);
        rays.add(is_far ? std::span<const float>(origin) : r.first(3), rest.first(3), rest[3]);
        if (color != 0) rays.add_wavelength(rest[4]);
    });
    rays.finish();
    return file;
}

}  // namespace etendue
