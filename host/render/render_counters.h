// What kernels count and add up over passes: rays, and where the light has gone.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace etendue {

// Of an optical element. What its lamps emit makes up what is missing.
struct ElementPower {
    double entered = 0, left = 0;
    double absorbed = 0;  // by its own surfaces and media, not by those of elements within it

    ElementPower& operator+=(const ElementPower& more) {
        entered += more.entered, left += more.left, absorbed += more.absorbed;
        return *this;
    }
};

// Sums over all passes. Importance: every path starts with 1.
struct RenderCounters {
    uint64_t rays = 0, shadow_rays = 0, non_finite = 0, depth_limit = 0;
    double escaped = 0, depth_limit_lost = 0;
    // Forward paths: their flux in units of the mean, so that each emits about 1.
    uint64_t forward_paths = 0, forward_rays = 0, forward_shadow_rays = 0, forward_non_finite = 0,
             forward_depth_limit = 0;
    uint64_t split_passes = 0;  // whose forward vertices did not fit, and that went on with fewer paths
    uint64_t forward_paths_a_pass = 0;  // of the first one: fewer where vertices did not fit
    double emitted = 0, absorbed = 0, forward_escaped = 0, forward_depth_limit_lost = 0;
    std::map<std::string, double> absorbed_by;     // … of `absorbed`: PowerLedger, where somebody asks
    std::map<std::string, ElementPower> elements;  // …
    double roulette = 0;  // what Russian roulette took, less what it gave to the survivors
};
uint64_t all_rays(const RenderCounters& counters);
void add(RenderCounters& counters, const RenderCounters& more);  // of other passes of the same run
nlohmann::json to_json(const RenderCounters& counters);
RenderCounters counters_from_json(const nlohmann::json& json);

}  // namespace etendue
