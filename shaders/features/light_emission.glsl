// Which light a forward ray leaves: in proportion to power (the luminous flux that the lights state), by an alias table
// (Walker 1977, Vose 1991) from host/scene/scene_lights.cpp.
//
// Random numbers have 24 bits. The host counts which of them lead to which light, so the probabilities are exact for
// the dimmest of a million lights too; one that shines at all is chosen by at least one of them.
//
// The host defines LIGHT_COUNT; a single light needs no table.
#include "lib/constants.glsl"
#include "lib/records.glsl"

#if LIGHT_COUNT > 1
struct EmissionChoice {
    uint threshold;     // of 2^24: below it the entry stands for its own light
    uint alias;         // the light it stands for otherwise
    float probability;  // of choosing the light of this number
};

layout(scalar, set = 0) readonly buffer LightEmission { EmissionChoice emission_choices[]; };
#endif

// Probability 0: no light shines.
uint choose_emitter(float u, out float probability) {
#if LIGHT_COUNT > 1
    uint high, low;  // u * LIGHT_COUNT, exactly
    umulExtended(min(uint(u * 16777216.0), 16777215u), uint(LIGHT_COUNT), high, low);
    uint entry = (high << 8) | (low >> 24);
    uint light = (low & 0xFFFFFFu) < emission_choices[entry].threshold ? entry : emission_choices[entry].alias;
    probability = emission_choices[light].probability;
    return light;
#else
    probability = float(LIGHT_COUNT);
    return 0u;
#endif
}

// The probability with which choose_emitter chooses `light`, by its number in the list of lights.
float emitter_probability(uint light) {
#if LIGHT_COUNT > 1
    return emission_choices[light].probability;
#else
    return float(LIGHT_COUNT);
#endif
}
