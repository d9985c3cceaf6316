// The film's mean radiance, one lane a pixel; black before the first pass.
// Reads: film. Writes: picture. Barrier expected: after the dispatch.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint pixels; };

#include "lib/film.glsl"

layout(scalar, set = 0) writeonly buffer Picture { vec3 picture[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= pixels) return;
    FilmPixel pixel = film[FILM_LAYERS * i];
    picture[i] = pixel.samples == 0u ? vec3(0) : (pixel.sum + pixel.compensation) / float(pixel.samples);
}
