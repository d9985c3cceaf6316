// The table by which shaders/features/light_emission.glsl chooses the light that a forward ray leaves.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

// Mirrors struct EmissionChoice of light_emission.glsl.
struct EmissionChoice {
    uint32_t threshold = 0;  // of 2^24
    uint32_t alias = 0;
    float probability = 0;  // of the light, not of the entry
};
static_assert(sizeof(EmissionChoice) == 12);

// An alias table in proportion to `powers` (at least 0; at most 2^24 of them) for random numbers that are
// multiples of 2^-24. Probabilities are counted, so they are what the table does; every power above 0 has one
// above 0, every other has none. All powers 0: all probabilities 0.
std::vector<EmissionChoice> build_emission_choices(std::span<const double> powers);

}  // namespace etendue
