#include "host/spectra/spectral_value.h"

#include <algorithm>

#include "host/spectra/color.h"

namespace etendue {

SpectralTable SpectralValue::as_table(SpectralKind kind) const {
    if (table) return *table;
    return kind == SpectralKind::radiance ? radiance_of_rgb(rgb) : factor_of_rgb(rgb);
}

float SpectralValue::least() const { return table ? table->least() : std::min({rgb.x, rgb.y, rgb.z}); }
float SpectralValue::greatest() const { return table ? table->greatest() : std::max({rgb.x, rgb.y, rgb.z}); }

}  // namespace etendue
