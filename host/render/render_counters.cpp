#include "host/render/render_counters.h"

#include <algorithm>
#include <vector>

namespace etendue {
namespace {

// Counters by the names under which a checkpoint keeps them.
template <class Counters, class Visit>
void visit_counters(Counters& c, Visit visit) {
    visit("rays", c.rays);
    visit("shadow_rays", c.shadow_rays);
    visit("non_finite", c.non_finite);
    visit("depth_limit", c.depth_limit);
    visit("escaped", c.escaped);
    visit("depth_limit_lost", c.depth_limit_lost);
    visit("forward_paths", c.forward_paths);
    visit("forward_paths_a_pass", c.forward_paths_a_pass);
    visit("forward_rays", c.forward_rays);
    visit("forward_shadow_rays", c.forward_shadow_rays);
    visit("forward_non_finite", c.forward_non_finite);
    visit("forward_depth_limit", c.forward_depth_limit);
    visit("split_passes", c.split_passes);
    visit("emitted", c.emitted);
    visit("absorbed", c.absorbed);
    visit("forward_escaped", c.forward_escaped);
    visit("forward_depth_limit_lost", c.forward_depth_limit_lost);
    visit("roulette", c.roulette);
}

}  // namespace

uint64_t all_rays(const RenderCounters& c) {
    return c.rays + c.shadow_rays + c.forward_rays + c.forward_shadow_rays;
}

nlohmann::json to_json(const RenderCounters& counters) {
    nlohmann::json json;
    visit_counters(counters, [&](const char* name, auto value) { json[name] = value; });
    if (!counters.absorbed_by.empty()) json["absorbed_by"] = counters.absorbed_by;
    for (const auto& [name, power] : counters.elements)
        json["elements"][name] = {power.entered, power.left, power.absorbed};
    return json;
}

void add(RenderCounters& counters, const RenderCounters& more) {
    std::vector<double> reals;
    std::vector<uint64_t> counts;
    const uint64_t paths_a_pass = std::max(counters.forward_paths_a_pass, more.forward_paths_a_pass);
    visit_counters(more, [&](const char*, auto value) {
        if constexpr (std::is_same_v<decltype(value), double>)
            reals.push_back(value);
        else
            counts.push_back(value);
    });
    size_t real = 0, count = 0;
    visit_counters(counters, [&](const char*, auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
            value += reals[real++];
        else
            value += counts[count++];
    });
    counters.forward_paths_a_pass = paths_a_pass;
    for (const auto& [name, flux] : more.absorbed_by) counters.absorbed_by[name] += flux;
    for (const auto& [name, power] : more.elements) counters.elements[name] += power;
}

RenderCounters counters_from_json(const nlohmann::json& json) {
    RenderCounters counters;
    visit_counters(counters, [&](const char* name, auto& value) {
        value = json.value(name, std::decay_t<decltype(value)>{});
    });
    counters.absorbed_by = json.value("absorbed_by", decltype(counters.absorbed_by){});
    for (const auto& [name, power] : json.value("elements", nlohmann::json::object()).items())
        counters.elements[name] = {power.at(0), power.at(1), power.at(2)};
    return counters;
}

}  // namespace etendue
