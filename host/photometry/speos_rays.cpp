// Ray files of Ansys Speos (.ray): 28 bytes, of which the first number is the flux in watts and the last that
// in lumens, then rays of 8 numbers (position in mm, direction, wavelength in nm, energy on a scale of its
// own), with five more where they are polarized: the great axis of the ellipse, its small axis over the great
// one, and which way it turns (0 right, 1 left), as its manual describes them ("Contents of ray files").
#include <algorithm>
#include <cmath>

#include "host/photometry/ray_reader.h"

namespace etendue {
namespace {

constexpr uint64_t header_bytes = 28;

// Light whose field is as long along the small axis of its ellipse as that is by the great one, 1.
RayPolarization of_ellipse(const glm::vec3& great_axis, float small_axis, bool turns_left) {
    const float size = 1 + small_axis * small_axis;
    return {{(1 - small_axis * small_axis) / size, 0, (turns_left ? -2 : 2) * small_axis / size}, great_axis};
}

// Whether the first rays have directions and wavelengths if each takes so many numbers.
bool fits(RayReader& in, uint32_t columns) {
    const uint64_t bytes = columns * sizeof(float);
    if (in.size <= header_bytes || (in.size - header_bytes) % bytes != 0) return false;
    bool good = true;
    in.for_each_ray(header_bytes, std::min<uint64_t>((in.size - header_bytes) / bytes, 64), columns,
                    [&](std::span<const float> r) {
                        const double length = std::hypot(r[3], r[4], r[5]);
                        good = good && std::abs(length - 1) < 0.01 && r[6] >= 100 && r[6] <= 1e5f;
                    });
    return good;
}

}  // namespace

bool looks_like_speos(RayReader& in) { return fits(in, 8) || fits(in, 13); }

RayFile read_speos(RayReader& in) {
    RayFile file;
    file.format = "Speos";
    const uint32_t columns = fits(in, 8) ? 8 : 13;
    const auto watts = in.number<float>(0);
    const auto lumens = in.number<float>(24);
    if (!(watts > 0 && watts < 1e30f)) in.fail(0, "the flux is {:.6g} W; must be a number above 0", watts);
    if (lumens > 1e-30f && lumens < 1e30f) file.stated_lumens = lumens;
    const uint64_t count = (in.size - header_bytes) / (columns * sizeof(float));
    RayCollector rays(file, in.name, 1);
    rays.reserve(count, fmt::format("byte {}", header_bytes));
    file.wavelengths.reserve(count);
    in.for_each_ray(header_bytes, count, columns, [&](std::span<const float> r) {
        rays.add(r.first(3), r.subspan(3, 3), r[7]);
        rays.add_wavelength(r[6]);
        if (columns == 13) rays.add_polarization(of_ellipse({r[8], r[9], r[10]}, r[11], r[12] != 0));
    });
    rays.finish();
    const double scale = watts / file.flux();
    for (SourceRay& ray : file.rays) ray.flux = float(ray.flux * scale);
    file.stated_watts = watts;
    return file;
}

}  // namespace etendue
