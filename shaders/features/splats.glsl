// What forward rays bring to the pixels in one pass: sums of integers, so that their order does not matter. Each lane of the
// spectrum is a pair, fraction (2^-32) and whole, of forward_pass.splat_unit.
#include "lib/forward_pass.glsl"
#include "features/defaults.glsl"
#include "features/spectrum.glsl"

layout(scalar, set = 0) buffer Splats { uint splats[]; };

// False: the value is none that the sums can hold.
bool add_splat(uint pixel, Spectrum radiance) {
    Spectrum value = radiance / forward_pass.splat_unit;
    if (!all(lessThan(abs(value), Spectrum(2e9)))) return false;
    for (uint i = 0u; i < LANES; ++i) {
        uint place = 2u * (LANES * pixel + i);
        float whole = floor(value[i]);
        uint fraction = uint(min((value[i] - whole) * 4294967296.0, 4294967040.0));
        uint before = atomicAdd(splats[place], fraction);
        uint carry = before + fraction < before ? 1u : 0u;
        if (whole != 0.0 || carry > 0u) atomicAdd(splats[place + 1u], uint(int(whole)) + carry);
    }
    return true;
}

// The sum of a pixel, which starts again from nothing.
Spectrum take_splats(uint pixel) {
    Spectrum sum;
    for (uint i = 0u; i < LANES; ++i) {
        uint place = 2u * (LANES * pixel + i);
        sum[i] = float(int(splats[place + 1u])) + float(splats[place]) * (1.0 / 4294967296.0);
        splats[place] = 0u;
        splats[place + 1u] = 0u;
    }
    return sum * forward_pass.splat_unit;
}

// Adds that sum to the radiance of a pixel and its colour.
#if HAS_SPLATS
void add_splats(uint pixel, inout Spectrum radiance, inout vec3 rgb) {
    Spectrum sum = take_splats(pixel);
    radiance += sum;
    rgb += spectrum_rgb(sum);
}
#else
#define add_splats(pixel, radiance, rgb)
#endif
