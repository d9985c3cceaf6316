#include "host/render/spectral_passes.h"

#include "host/spectra/color.h"
#include "host/spectra/wavelengths.h"

namespace etendue {
namespace {

constexpr uint32_t most_passes = 64;

}  // namespace

SpectralPasses::SpectralPasses(Device& device, const Scene& scene) : scene_(scene) {
    if (!scene.features.spectral) return;
    wavelengths_ = Buffer(device, most_passes * sizeof(Wavelengths), "WavelengthTable");
    values_ =
        Buffer(device, most_passes * scene.features.spectrum_count * sizeof(glm::vec4), "SpectrumValues");
    colors_ = Buffer(device, color_spectra_count * sizeof(glm::vec4), "ColorSpectra");
}

BufferTable SpectralPasses::buffers() const {
    if (!scene_.features.spectral) return {};
    return {{"WavelengthTable", &wavelengths_}, {"SpectrumValues", &values_}, {"ColorSpectra", &colors_}};
}

uint32_t SpectralPasses::capacity() const { return scene_.features.spectral ? most_passes : ~0u; }

void SpectralPasses::write(uint64_t first, uint32_t count, uint32_t seed) {
    if (!scene_.features.spectral) return;
    if (scene_.reads_color_spectra && !has_colors_) {  // which take a quarter of a second
        colors_.write(color_spectra().data(), colors_.bytes());
        has_colors_ = true;
    }
    std::vector<Wavelengths> wavelengths;
    std::vector<glm::vec4> values;
    for (uint32_t pass = 0; pass < count; ++pass) {
        wavelengths.push_back(choose_wavelengths(first + pass, seed));
        const glm::vec4& nm = wavelengths.back().nm;
        for (const SpectralTable& s : scene_.spectra)
            values.emplace_back(s.at(nm.x), s.at(nm.y), s.at(nm.z), s.at(nm.w));
        values.resize((pass + 1) * scene_.features.spectrum_count);
    }
    wavelengths_.write(wavelengths.data(), wavelengths.size() * sizeof(Wavelengths));
    values_.write(values.data(), values.size() * sizeof(glm::vec4));
}

}  // namespace etendue
