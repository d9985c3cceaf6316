// Ray files of LightTools (.ray): "LTRF", a header of 44 bytes, rays of 7 or 8 numbers, "LTRFEND". The layout
// is that of TM25RaySetTools (J. Muschaweck).
#include "host/photometry/ray_reader.h"

namespace etendue {
namespace {

constexpr uint64_t header_bytes = 44, end_bytes = 7;
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
    if (const auto version = in.number<uint32_t>(4); version != 2)
        in.fail(4, "version {}; must be 2 (3 has polarization)", version);
    file.unit = in.choice(12, "the kind of data", 0, 1) == 0 ? RayFile::Unit::watt : RayFile::Unit::lumen;
    in.choice(16, "far field data, which has no positions,", 0, 0);
    const auto color = in.number<uint32_t>(20);
    if (color != 0 && color != 2)
        in.fail(20, "the kind of colour is {}; must be 0 (none) or 2 (wavelengths)", color);
    const int32_t unit = in.choice(24, "the unit of length", 0, 7);
    if (unit == 0)
        file.warnings.emplace_back("the unit of length is that of a system which is not told: taken as mm");
    if (in.number<float>(28) != 0 || in.number<float>(32) != 0 || in.number<float>(36) != 0)
        file.warnings.emplace_back("its origin is not 0: positions are taken as they stand");
    if (const auto flux = in.number<float>(40); flux > 1e-30f && flux < 1e30f)
        (file.unit == RayFile::Unit::watt ? file.stated_watts : file.stated_lumens) = flux;
    const uint32_t columns = color == 0 ? 7 : 8, bytes = columns * sizeof(float);
    const uint64_t body = in.size - std::min(in.size, header_bytes + end_bytes);
    if (body == 0 || body % bytes != 0)
        in.fail(header_bytes, "{} bytes of rays; must be a multiple of {}, and 'LTRFEND' behind them", body,
                bytes);
    char end[end_bytes];
    in.read(in.size - end_bytes, std::as_writable_bytes(std::span(end)));
    if (std::string_view(end, end_bytes) != "LTRFEND") in.fail(in.size - end_bytes, "must be 'LTRFEND'");
    RayCollector rays(file, in.name, mm_of_unit[unit]);
    rays.reserve(body / bytes, fmt::format("byte {}", header_bytes));
    if (columns == 8) file.wavelengths.reserve(body / bytes);
    in.for_each_ray(header_bytes, body / bytes, columns, [&](std::span<const float> r) {
        rays.add(r.first(3), r.subspan(3, 3), r[6]);
        if (columns == 8) rays.add_wavelength(r[7]);
    });
    rays.finish();
    return file;
}

}  // namespace etendue
