#include "host/measure/ray_export.h"

#include "host/measure/figures.h"
#include "host/spectra/color.h"

namespace etendue {

std::optional<RayFile> recorded_rays(const Readings& readings) {
    double recorded = 0;
    for (const RayCrossing& c : readings.rays.crossings) recorded += c.lumens;
    if (!(recorded > 0)) return {};
    double measured = 0;
    const auto values = luminous_values(readings);
    for (const auto& replicate : values)
        for (size_t i = 0; i < replicate.size(); ++i)
            measured += replicate[i] * readings.meter.places[i].extent / replicates;
    const double scale = measured / recorded;
    RayFile file;
    file.format = "TM-25";
    file.texts = {readings.meter.name, "", "", "etendue " ETENDUE_VERSION, "", "", "", "", ""};
    file.stated_lumens = measured;
    for (const RayCrossing& c : readings.rays.crossings) {
        if (c.nm.x > 0) {
            file.unit = RayFile::Unit::watt;
            for (int i = 0; i < 4; ++i) {
                if (!(c.flux[i] > 0)) continue;
                file.rays.push_back({c.position, c.direction, float(scale * double(c.flux[i]))});
                file.wavelengths.push_back(c.nm[i]);
            }
        } else if (c.lumens > 0) {
            file.unit = RayFile::Unit::lumen;
            const glm::dvec3 xyz = scale * xyz_of_rgb(glm::dvec3(c.flux));
            file.rays.push_back({c.position, c.direction, float(scale * double(c.lumens))});
            file.tristimulus.push_back({xyz.x, xyz.z});
        }
    }
    return file;
}

}  // namespace etendue
