#include "host/render/exact_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace etendue {
namespace {

using Digit = std::array<uint32_t, 3>;

uint64_t joined(const Digit& low, const Digit& high, size_t c) { return uint64_t(high[c]) << 32 | low[c]; }

void add(Digit& low, Digit& high, size_t c, uint64_t summand) {
    const uint64_t sum = joined(low, high, c) + summand;
    low[c] = uint32_t(sum), high[c] = uint32_t(sum >> 32);
}

void raise(ExactSum& sum, uint32_t window) {
    if (window <= sum.window) return;
    const bool next = window == sum.window + 1;
    sum.lower = next ? sum.upper : Digit{};
    sum.lower_high = next ? sum.upper_high : Digit{};
    sum.upper = sum.upper_high = {};
    sum.window = window;
}

}  // namespace

void merge(ExactSum& sum, const ExactSum& other) {
    ExactSum summand = other;
    raise(summand, sum.window);
    raise(sum, summand.window);
    for (size_t c = 0; c < 3; ++c) {
        add(sum.upper, sum.upper_high, c, joined(summand.upper, summand.upper_high, c));
        add(sum.lower, sum.lower_high, c, joined(summand.lower, summand.lower_high, c));
    }
}

void merge(std::span<ExactSum> sums, std::span<const ExactSum> others) {
    for (size_t i = 0; i < sums.size(); ++i) merge(sums[i], others[i]);
}

glm::dvec3 value(const ExactSum& sum) {
    glm::dvec3 result;
    const double unit = std::ldexp(1.0, 24 * (int(sum.window) - 6));
    for (size_t c = 0; c < 3; ++c) {
        const __int128 whole = int64_t(joined(sum.upper, sum.upper_high, c));
        const __int128 total = whole * (1 << 24) + int64_t(joined(sum.lower, sum.lower_high, c));
        result[int(c)] = double(total) * unit;
    }
    return result;
}

void add_exactly(ExactSum& sum, const glm::vec3& value) {
    const glm::vec3 size = glm::abs(value);
    const uint32_t exponent = std::bit_cast<uint32_t>(std::max({size.x, size.y, size.z})) >> 23;
    raise(sum, (std::max(exponent, 6u) - 6) / 24);
    for (size_t c = 0; c < 3; ++c) {
        const double scaled = std::ldexp(double(value[int(c)]), 24 * (5 - int(sum.window)));
        const double upper = std::nearbyint(scaled);
        add(sum.upper, sum.upper_high, c, uint64_t(int64_t(upper)));
        add(sum.lower, sum.lower_high, c, uint64_t(int64_t(std::nearbyint((scaled - upper) * 0x1p24))));
    }
}

}  // namespace etendue
