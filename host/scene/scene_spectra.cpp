// Spectra that the records of a scene refer to, and whether it is rendered with them.
#include "host/error.h"
#include "host/scene/scene_compiler.h"
#include "host/spectra/color.h"

namespace etendue {

uint32_t SceneCompiler::add_spectrum(const SpectralValue& value, SpectralKind kind) {
    for (uint32_t i = 0; i < spectra_.size() && i < 64; ++i)  // what many share is likely among the first
        if (spectra_[i].second == kind && spectra_[i].first == value) return i;
    spectra_.push_back({value, kind});
    return uint32_t(spectra_.size() - 1);
}

// The value times the spectrum. Where the value is a photometric quantity or a power it fixes the scale, and
// the spectrum only gives the colour.
SpectralValue SceneCompiler::emitted_spectrum(const EmissionDescription& e) {
    using Quantity = EmissionDescription::Quantity;
    const SpectralValue value = spectral_value(e.value, in_, e.where, SpectralKind::radiance);
    if (value.table && e.quantity != Quantity::radiance)
        fail_input("{}: allowed: a number or [r, g, b]; a spectrum stands beside it as \"spectrum\"",
                   message_place(in_, e.where));
    if (e.spectrum.is_null()) return value;
    if (value.table)
        fail_input("{}/spectrum: the radiance is a spectrum already", message_place(in_, e.where));
    SpectralValue spectrum = spectral_value(e.spectrum, in_, e.where + "/spectrum", SpectralKind::radiance);
    double scale = 1;
    if (e.quantity != Quantity::radiance) {
        const double y =
            spectrum.table ? xyz_of_radiance(*spectrum.table).y : luminance(glm::dvec3(spectrum.rgb));
        if (!(y > 0)) fail_input("{}/spectrum: must not be black", message_place(in_, e.where));
        scale = 1 / y;
    }
    SpectralValue product{value.rgb * spectrum.rgb * float(scale), {}};
    if (spectrum.table) product.table = *spectrum.table * factor_of_rgb(value.rgb) * scale;
    return product;
}

void SceneCompiler::scale_emission(MaterialRecord& record, float scale) {
    SpectralValue value = spectra_[record.emission.table].first;
    value.rgb *= scale;
    if (value.table) value.table = *value.table * scale;
    record.emission.rgb *= scale;
    record.emission.table = add_spectrum(value, SpectralKind::radiance);
}

// Last of all: what measures lights and materials does so in colours.
void SceneCompiler::choose_color() {
    bool has_tables = out_.features.scattering && !mie_tables_.empty();
    for (const auto& [value, kind] : spectra_) has_tables |= value.table.has_value();
    bool disperses = false;
    for (const auto& [interface, classes] : out_.classes)
        for (const ClassInfo* info : classes) disperses |= info->disperses;
    out_.features.spectral =
        options_.color == ColorMode::spectral ||
        (options_.color == ColorMode::automatic && (has_tables || disperses || options_.spectral_image));
    if (!out_.features.spectral) return;
    out_.features.dispersion = disperses;
    const double radiance_unit = even_luminance();
    for (const auto& [value, kind] : spectra_) {
        out_.features.dispersion |=
            kind == SpectralKind::index && value.table && value.least() < value.greatest();
        const SpectralTable table = value.as_table(kind);
        out_.spectra.push_back(kind == SpectralKind::radiance ? table * radiance_unit : table);
    }
    if (uses_measured_) share("MeasuredSpectra", memory_.measured.spectra);
    out_.features.spectrum_count =
        uint32_t((out_.spectra.size() + 15) / 16 * 16);  // so that it seldom changes
}

}  // namespace etendue
