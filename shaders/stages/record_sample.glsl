// What a finished backward path has collected becomes a sample of its pixel, with what forward rays have brought there in
// the same pass, in the colours of the film and in the bins of a spectral image. What is not finite counts as black.
#include "features/bias.glsl"
#include "features/spectral_film.glsl"
#include "features/splats.glsl"
#include "lib/counters.glsl"
#include "lib/samples.glsl"

// `place`: of layer 0 in the samples.
void record_sample(uint place, uint pixel, Path path, inout Counters counters) {
    Collected radiance = path.radiance;
    bool finite = true;
    for (uint layer = 0u; layer < FILM_LAYERS; ++layer) finite = finite && is_finite(spectrum_rgb(film_layer(radiance, layer)));
    if (!finite) {
        counters.non_finite++;
        radiance = nothing_collected();
    }
    add_splats(pixel, radiance);
    add_to_bins(pixel, radiance);
    for (uint layer = 0u; layer < FILM_LAYERS; ++layer)
        samples[place + layer] = make_sample(spectrum_rgb(film_layer(radiance, layer)), path, layer);
}
