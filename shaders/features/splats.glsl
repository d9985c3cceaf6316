// What forward rays bring to the pixels in one pass: sums of integers, so that their order does not matter. Each lane of the
// spectra is a pair, fraction (2^-32) and whole, of forward_pass.splat_unit.
#include "features/defaults.glsl"
#include "features/film_layers.glsl"
#include "lib/forward_pass.glsl"

layout(scalar, set = 0) buffer Splats { uint splats[]; };

uint splat_place(uint pixel, uint layer, uint lane) { return 2u * (LANES * (SPLAT_LAYERS * pixel + layer) + lane); }

// False: the value is none that the sums can hold.
bool add_splat(uint pixel, Brought brought) {
    Received radiance = light_of(brought);
    for (uint layer = 0u; layer < STOKES_LAYERS; ++layer)
        if (!all(lessThan(abs(stokes_layer(radiance, layer) / forward_pass.splat_unit), Spectrum(2e9)))) return false;
    for (uint layer = 0u; layer < STOKES_LAYERS; ++layer) {
        Spectrum value = stokes_layer(radiance, layer) / forward_pass.splat_unit;
        for (uint i = 0u; i < LANES; ++i) {
            uint place = splat_place(pixel, splat_layer(brought, layer), i);
            float whole = floor(value[i]);
            uint fraction = uint(min((value[i] - whole) * 4294967296.0, 4294967040.0));
            uint before = atomicAdd(splats[place], fraction);
            uint carry = before + fraction < before ? 1u : 0u;
            if (whole != 0.0 || carry > 0u) atomicAdd(splats[place + 1u], uint(int(whole)) + carry);
        }
    }
    return true;
}

// The sum of a pixel, which starts again from nothing.
Spectrum take_layer(uint pixel, uint layer) {
    Spectrum sum;
    for (uint i = 0u; i < LANES; ++i) {
        uint place = splat_place(pixel, layer, i);
        sum[i] = float(int(splats[place + 1u])) + float(splats[place]) * (1.0 / 4294967296.0);
        splats[place] = 0u;
        splats[place + 1u] = 0u;
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
