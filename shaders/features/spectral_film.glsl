// The film of a spectral image: for every pixel, in each of its layers, SPECTRAL_BINS sums of spectral radiance, W / (m^2 sr nm),
// over equal shares of the visible range, and what each addition has lost (lib/film.glsl). A pass adds to four bins of a layer at most.
#include "features/defaults.glsl"
#include "features/stokes_images.glsl"

#if SPECTRAL_BINS > 0
layout(scalar, set = 0) buffer SpectralFilm { vec2 spectral_film[]; };  // sum, compensation

void add_to_bins(uint pixel, Received radiance) {
    Wavelengths w = wavelengths[batch_pass];
    for (uint i = 0u; i < 4u * FILM_LAYERS; ++i) {
        uint lane = i % 4u, layer = i / 4u;
        uint bin = min(uint((w.nm[lane] - 360.0) * (float(SPECTRAL_BINS) / 470.0)), uint(SPECTRAL_BINS - 1));
        uint place = (FILM_LAYERS * pixel + layer) * uint(SPECTRAL_BINS) + bin;
        vec2 entry = spectral_film[place];
        float value = layer_of(radiance, layer)[lane] * w.share[lane] * (float(SPECTRAL_BINS) / 470.0);
        precise float total = entry.x + value;
        precise float lost = abs(entry.x) >= abs(value) ? (entry.x - total) + value : (value - total) + entry.x;
        spectral_film[place] = vec2(total, entry.y + lost);
    }
}
#else
#define add_to_bins(pixel, radiance)
#endif
