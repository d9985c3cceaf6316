// What a finished backward path has collected becomes the next sample of its pixel, with what forward rays have brought there in
// the same pass, in the colours of the film and in the bins of a spectral image. What is not finite counts as black.
#include "features/bias.glsl"
#include "features/spectral_film.glsl"
#include "features/splats.glsl"
#include "lib/counters.glsl"
#include "lib/film.glsl"

void record_layer(inout FilmPixel film, uint layer, Path path, Received radiance) {
    record_bias(film, path, layer);
    add_sample(film, spectrum_rgb(layer_of(radiance, layer)));
}

// `first`: layer of the pixel, which the caller keeps; the others stand in memory.
void record_sample(inout FilmPixel first, uint pixel, Path path, inout Counters counters) {
    Received radiance = path.radiance;
    bool finite = true;
    for (uint layer = 0u; layer < FILM_LAYERS; ++layer) finite = finite && is_finite(spectrum_rgb(layer_of(radiance, layer)));
    if (!finite) {
        counters.non_finite++;
        radiance = Received(0);
    }
    add_splats(pixel, radiance);
    add_to_bins(pixel, radiance);
    record_layer(first, 0u, path, radiance);
    for (uint layer = 1u; layer < FILM_LAYERS; ++layer) {
        uint place = FILM_LAYERS * pixel + layer;
        FilmPixel entry = film[place];
        record_layer(entry, layer, path, radiance);
        film[place] = entry;
    }
}
