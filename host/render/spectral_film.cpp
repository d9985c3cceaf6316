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
      sums_(device, uint64_t(pixels) * layers_ * bins * sizeof(glm::vec2), "SpectralFilm") {
    clear();
}

BufferTable SpectralFilm::buffers() const { return {{"SpectralFilm", &sums_}}; }

void SpectralFilm::clear() { sums_.fill(0); }

std::vector<std::byte> SpectralFilm::read() const { return sums_.read_array<std::byte>(sums_.bytes()); }

void SpectralFilm::write(const std::vector<std::byte>& state) { sums_.write(state.data(), state.size()); }

void SpectralFilm::add_to(Image& image, uint64_t passes) const {
    const auto sums =
        sums_.read_array<glm::vec2>(uint64_t(pixels_) * layers_ * bins_);  // and what they have lost
    std::vector<float> means(sums.size());
    for (size_t i = 0; i < sums.size(); ++i)
        means[i] = passes ? float((double(sums[i].x) + double(sums[i].y)) / double(passes)) : 0.0f;
    std::vector<std::string> names;
    for (uint32_t layer = 0; layer < layers_; ++layer)
        for (uint32_t bin = 0; bin < bins_; ++bin) names.push_back(spectral_channel(bin, bins_, layer));
    add_channels(image, names, means, names.size());
    image.attributes["spectralLayoutVersion"] = std::string("1.0");
    image.attributes["emissiveUnits"] = std::string("W.m^-2.sr^-1.nm^-1");
    if (layers_ > 1) image.attributes["polarisationHandedness"] = std::string("right");
}

std::string spectral_channel(uint32_t bin, uint32_t bins, uint32_t parameter) {
    const double nm = first_nm + (bin + 0.5) * (last_nm - first_nm) / bins;
    std::string text = fmt::format("S{}.{:.6f}nm", parameter, nm);
    std::replace(text.begin() + 3, text.end(), '.', ',');
    return text;
}

}  // namespace etendue
