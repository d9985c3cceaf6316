// Where the light of a measurement has gone, by the forward rays.
#include <fmt/format.h>

#include "host/measure/report.h"

namespace etendue {
std::vector<BalanceLine> balance_of(const Measurement& measurement) {
    const RenderCounters& all = measurement.counters;
    std::vector<BalanceLine> lines;
    if (all.forward_paths == 0) return lines;
    const double lumens = measurement.power / double(all.forward_paths);
    const auto add = [&](const std::string& name, double flux, const char* text) {
        lines.push_back({name, flux * lumens, text});
    };
    add("emitted", all.emitted, "by forward rays");
    add("absorbed", all.absorbed, "by surfaces and media");
    for (const auto& [name, flux] : all.absorbed_by) add("absorbed by " + name, flux, "of these");
    for (const auto& [name, power] : all.elements) {
        add("entered " + name, power.entered, "came into this element");
        add("left " + name, power.left, "came out of it again, and of its lamps");
        add("absorbed in " + name, power.absorbed, "within it, of the above");
    }
    add("escaped", all.forward_escaped, "left the scene");
    add("lost", all.forward_depth_limit_lost, "at the depth limit");
    add("roulette", all.roulette, "taken by Russian roulette less what it gave back: noise around 0");
    add("difference",
        all.emitted - all.absorbed - all.forward_escaped - all.forward_depth_limit_lost - all.roulette,
        "rounding");
    for (const Readings& readings : measurement.meters)
        if (const auto flux = received_flux(readings))
            lines.push_back({"received by " + readings.meter.name, *flux, "passes on, and ends above"});
    return lines;
}

}  // namespace etendue
