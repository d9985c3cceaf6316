#include "host/photometry/photometric_text.h"

#include <algorithm>
#include <cmath>

#include "host/image/atomic_file.h"

namespace etendue {

double PhotometricText::candela(size_t line, double value, const std::string& what) const {
    if (value > max_candela) fail(line, "{} is {:.3g} cd; must be at most {:.0e}", what, value, max_candela);
    return value;
}

std::string read_photometric_bytes(const std::filesystem::path& file) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > 256 << 20)
        fail_input("{}: {} bytes; a photometric file has at most 256 MiB", file.string(), size);
    const std::vector<std::byte> bytes = read_whole_file(file);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

PhotometricText photometric_text(const std::string& file, std::string bytes) {
    return {text_lines(file, std::move(bytes))};
}

void mirror_planes(std::vector<PhotometricPlane>& planes, bool across_c0, bool across_c90) {
    if (planes.size() == 1) return;
    const auto add_images = [&](double sum) {  // of the longitudes of a plane and its image
        for (size_t i = 0, count = planes.size(); i < count; ++i)
            planes.push_back({sum - planes[i].longitude, planes[i].candela});
    };
    if (across_c0) add_images(360);
    if (across_c90) add_images(180);
    const auto turns = [](double longitude) { return longitude - 360 * std::floor(longitude / 360); };
    if (across_c0 || across_c90) {
        for (PhotometricPlane& p : planes) p.longitude = turns(p.longitude);
        std::stable_sort(planes.begin(), planes.end(),
                         [](auto& a, auto& b) { return a.longitude < b.longitude; });
        const auto same = [](auto& a, auto& b) { return std::abs(a.longitude - b.longitude) < 1e-6; };
        planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
        if (planes.size() > 1 && planes.back().longitude - planes[0].longitude > 360 - 1e-6)
            planes.pop_back();
    }
    if (planes.back().longitude - planes[0].longitude < 360 - 1e-6)
        planes.push_back({planes[0].longitude + 360, planes[0].candela});
}

void set_table(IntensityDistribution& d, const std::vector<PhotometricPlane>& planes) {
    size_t negative = 0;
    for (const PhotometricPlane& p : planes) {
        d.planes.push_back(p.longitude);
        for (const double candela : p.candela) {
            negative += candela < 0;
            d.candela.push_back(std::max(candela, 0.0));
        }
    }
    if (negative) d.warnings.push_back(fmt::format("{} intensities are negative: taken as 0", negative));
}

void compare_flux(IntensityDistribution& d, double stated, const char* what) {
    const double flux = d.flux();
    if (!(flux > 0)) d.warnings.emplace_back("the table holds no light");
    if (stated > 0 && std::abs(flux / stated - 1) > 0.03)
        d.warnings.push_back(
            fmt::format("the table holds {:.6g} lm, {} {:.6g} lm: the table counts", flux, what, stated));
}

}  // namespace etendue
