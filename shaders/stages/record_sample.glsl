// The radiance of a finished backward path becomes the next sample of its pixel, with what forward rays have brought there in
// the same pass, in the colours of the film and in the bins of a spectral image. What is not finite counts as black.
#include "features/spectral_film.glsl"
#include "features/splats.glsl"
#include "lib/counters.glsl"
#include "lib/film.glsl"

void record_sample(inout FilmPixel film, uint pixel, Spectrum radiance, inout Counters counters) {
    vec3 rgb = spectrum_rgb(radiance);
    if (!is_finite(rgb)) {
        counters.non_finite++;
        radiance = Spectrum(0);
        rgb = vec3(0);
    }
    add_splats(pixel, radiance, rgb);
    add_to_bins(pixel, radiance);
    add_sample(film, rgb);
}
