#include "host/lights/emission_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/lights/environment_map.h"

namespace etendue {
namespace {

constexpr uint64_t resolution = 1 << 24;                             // of the random numbers
constexpr double largest_power = std::numeric_limits<float>::max();  // infinite ones count as this

// Random numbers k / 2^24 lead to entry k * count >> 24 with the remainder k * count mod 2^24. In entry i
// that is first(i), first(i) + count, and so on.
uint64_t first_remainder(uint64_t i, uint64_t count) { return (count - i * resolution % count) % count; }
uint64_t remainders_below(uint64_t limit, uint64_t first, uint64_t count) {
    return limit > first ? (limit - first + count - 1) / count : 0;
}

}  // namespace

std::vector<EmissionChoice> build_emission_choices(std::span<const double> powers) {
    const uint64_t count = powers.size();
    std::vector<EmissionChoice> choices(count);
    const auto brightest = std::max_element(powers.begin(), powers.end());
    if (brightest == powers.end() || !(*brightest > 0)) return choices;
    std::vector<double> weights;
    for (double power : powers) weights.push_back(std::min(power, largest_power));
    const AliasTable table = build_alias_table(weights);
    std::vector<uint64_t> times(count);
    for (uint64_t i = 0; i < count; ++i) {
        const uint64_t first = first_remainder(i, count);
        const bool shines = weights[i] > 0;
        uint64_t threshold = uint64_t(std::lround(std::min(table.threshold[i], 1.0) * double(resolution)));
        uint32_t alias = table.alias[i];
        // What rounding left in the table, or would take from a light that is dim.
        threshold = shines ? std::max(threshold, first + 1) : 0;
        if (!(weights[alias] > 0)) alias = uint32_t(brightest - powers.begin());
        const uint64_t own = remainders_below(threshold, first, count);
        times[i] += own;
        times[alias] += remainders_below(resolution, first, count) - own;
        choices[i].threshold = uint32_t(threshold), choices[i].alias = alias;
    }
    for (uint64_t i = 0; i < count; ++i)
        choices[i].probability = float(double(times[i]) / double(resolution));
    return choices;
}

}  // namespace etendue
