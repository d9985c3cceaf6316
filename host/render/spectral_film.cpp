#include "host/render/spectral_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/glm.hpp>

#include "host/spectra/spectrum.h"

namespace etendue {

SpectralFilm::SpectralFilm(Device& device, uint32_t pixels, uint32_t bins, bool stokes)
    : pixels_(pixels),
      bins_(bins),
      layers_(stokes ? 4 : 1),
      sums_(device, sums() * sizeof(ExactSum), "SpectralFilm") {
    clear();
}

BufferTable SpectralFilm::buffers() const { return {{"SpectralFilm", &sums_}}; }

void SpectralFilm::clear() { sums_.fill(0); }

std::vector<ExactSum> SpectralFilm::read() const { return sums_.read_array<ExactSum>(sums()); }

void SpectralFilm::write(const std::vector<ExactSum>& sums) {
    sums_.write(sums.data(), sums.size() * sizeof(ExactSum));
}

void add_spectra(Image& image, std::span<const ExactSum> sums, uint32_t bins, uint32_t layers,
                 uint64_t passes) {
    std::vector<float> means;
    means.reserve(pixel_count(image) * layers * bins);
    const size_t sums_a_layer = (bins + 2) / 3;
    for (size_t layer = 0; layer < pixel_count(image) * layers; ++layer)
        for (uint32_t bin = 0; bin < bins; ++bin) {
            const double sum = value(sums[layer * sums_a_layer + bin / 3])[int(bin % 3)];
            means.push_back(passes ? float(sum / double(passes)) : 0.0f);
        }
    std::vector<std::string> names;
    for (uint32_t layer = 0; layer < layers; ++layer)
        for (uint32_t bin = 0; bin < bins; ++bin) names.push_back(spectral_channel(bin, bins, layer));
    add_channels(image, names, means, names.size());
    image.attributes["spectralLayoutVersion"] = std::string("1.0");
    image.attributes["emissiveUnits"] = std::string("W.m^-2.sr^-1.nm^-1");
    if (layers > 1) image.attributes["polarisationHandedness"] = std::string("right");
}

std::string spectral_channel(uint32_t bin, uint32_t bins, uint32_t parameter) {
    const double nm = first_nm + (bin + 0.5) * (last_nm - first_nm) / bins;
    std::string text = fmt::format("S{}.{:.6f}nm", parameter, nm);
    std::replace(text.begin() + 3, text.end(), '.', ',');
    return text;
}

}  // namespace etendue
