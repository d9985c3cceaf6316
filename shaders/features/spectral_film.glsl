// The film of a spectral image: for every pixel, in each of its layers of a Stokes image, SPECTRAL_BINS sums of spectral radiance, W / (m^2 sr nm),
// over equal shares of the visible range, three bins a sum (lib/exact_sum.glsl). A pass adds to four bins of a layer at most.
#include "features/defaults.glsl"
#include "features/film_layers.glsl"
#include "lib/exact_sum.glsl"

#if SPECTRAL_BINS > 0
const uint BIN_SUMS = (uint(SPECTRAL_BINS) + 2u) / 3u;
layout(scalar, set = 0) buffer SpectralFilm { ExactSum spectral_film[]; };

void add_to_bins(uint pixel, Collected radiance) {
    Wavelengths w = wavelengths[batch_pass];
    for (uint i = 0u; i < 4u * STOKES_LAYERS; ++i) {
        uint lane = i % 4u, layer = i / 4u;
        uint bin = min(uint((w.nm[lane] - 360.0) * (float(SPECTRAL_BINS) / 470.0)), uint(SPECTRAL_BINS - 1));
        uint place = (STOKES_LAYERS * pixel + layer) * BIN_SUMS + bin / 3u;
        Digits sum = no_digits();
        vec3 value = vec3(0);
        value[bin % 3u] = film_layer(radiance, layer)[lane] * w.share[lane] * (float(SPECTRAL_BINS) / 470.0);
        add_exactly(sum, value);
        ADD_DIGITS(spectral_film[place], sum)
    }
}
#else
#define add_to_bins(pixel, radiance)
#endif
