// What forward rays bring to the pixels in one pass: sums of integers, so that their order does not matter. Each lane of the
// spectra has 96 bits, lowest word first, in units of 2^-64 of forward_pass.splat_unit: a small scene before a large meter needs those
// at the lower end.
#include "features/defaults.glsl"
#include "features/film_layers.glsl"
#include "lib/forward_pass.glsl"

layout(scalar, set = 0) buffer Splats { uint splats[]; };

uint splat_place(uint pixel, uint layer, uint lane) { return 3u * (LANES * (SPLAT_LAYERS * pixel + layer) + lane); }

// Below 2^31.
void add_exactly(uint place, float value) {
    float whole = floor(abs(value)), rest = (abs(value) - whole) * 4294967296.0, middle = floor(rest);
    uvec3 words = uvec3((rest - middle) * 4294967296.0, middle, whole);
    if (value < 0.0) words = ~words;  // less by 2^-64
    if (words.x != 0u && atomicAdd(splats[place], words.x) > ~words.x && ++words.y == 0u) ++words.z;
    if (words.y != 0u && atomicAdd(splats[place + 1u], words.y) > ~words.y) ++words.z;
    if (words.z != 0u) atomicAdd(splats[place + 2u], words.z);
}

// False: the value is none that the sums can hold.
bool add_splat(uint pixel, Brought brought) {
    Received radiance = light_of(brought);
    for (uint layer = 0u; layer < STOKES_LAYERS; ++layer)
        if (!all(lessThan(abs(stokes_layer(radiance, layer) / forward_pass.splat_unit), Spectrum(2e9)))) return false;
    for (uint layer = 0u; layer < STOKES_LAYERS; ++layer) {
        Spectrum value = stokes_layer(radiance, layer) / forward_pass.splat_unit;
        for (uint i = 0u; i < LANES; ++i) add_exactly(splat_place(pixel, splat_layer(brought, layer), i), value[i]);
    }
    return true;
}

// The sum of a pixel, which starts again from nothing.
Spectrum take_layer(uint pixel, uint layer) {
    Spectrum sum;
    for (uint i = 0u; i < LANES; ++i) {
        uint place = splat_place(pixel, layer, i);
        uvec3 words = uvec3(splats[place], splats[place + 1u], splats[place + 2u]);
        bool negative = int(words.z) < 0;
        vec3 digits = vec3(negative ? ~words : words);
        sum[i] = digits.z + (digits.y + digits.x * (1.0 / 4294967296.0)) * (1.0 / 4294967296.0);
        if (negative) sum[i] = -sum[i];
        for (uint k = 0u; k < 3u; ++k) splats[place + k] = 0u;
    }
    return sum * forward_pass.splat_unit;
}

// Adds that sum to what backward rays have brought.
#if HAS_SPLATS && LIGHT_LAYERS > 0
void add_splats(uint pixel, inout Collected radiance) {
    for (int i = 0; i < LIGHT_LAYERS; ++i) radiance.layers[i] += take_layer(pixel, uint(i));
}
#elif HAS_SPLATS && STOKES_IMAGE
void add_splats(uint pixel, inout Received radiance) {
    for (uint layer = 0u; layer < STOKES_LAYERS; ++layer) radiance[layer] += take_layer(pixel, layer);
}
#elif HAS_SPLATS
void add_splats(uint pixel, inout Received radiance) { radiance += take_layer(pixel, 0u); }
#else
#define add_splats(pixel, radiance)
#endif
