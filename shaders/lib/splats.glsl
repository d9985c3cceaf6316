// What forward rays bring to the pixels in one pass: sums of integers, so that their order does not matter. Each channel is a
// pair, fraction (2^-32) and whole (signed: saturated wavelengths have negative channels), of forward_pass.splat_unit.
#include "lib/forward_pass.glsl"
#include "lib/spectrum.glsl"

layout(scalar, set = 0) buffer Splats { uint splats[]; };

// False: the value is none that the sums can hold.
bool add_splat(uint pixel, Spectrum radiance) {
    vec3 value = spectrum_rgb(radiance) / forward_pass.splat_unit;
    if (!all(lessThan(abs(value), vec3(2e9)))) return false;
    for (uint i = 0u; i < 3u; ++i) {
        float whole = floor(value[i]);
        uint fraction = uint(min((value[i] - whole) * 4294967296.0, 4294967040.0));
        uint before = atomicAdd(splats[6u * pixel + 2u * i], fraction);
        uint carry = before + fraction < before ? 1u : 0u;
        if (whole != 0.0 || carry > 0u) atomicAdd(splats[6u * pixel + 2u * i + 1u], uint(int(whole)) + carry);
    }
    return true;
}

// The sum of a pixel, which starts again from nothing.
vec3 take_splats(uint pixel) {
    vec3 sum;
    for (uint i = 0u; i < 3u; ++i) {
        uint place = 6u * pixel + 2u * i;
        sum[i] = float(int(splats[place + 1u])) + float(splats[place]) * (1.0 / 4294967296.0);
        splats[place] = 0u;
        splats[place + 1u] = 0u;
    }
    return sum * forward_pass.splat_unit;
}
