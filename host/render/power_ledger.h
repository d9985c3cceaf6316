// What materials and media have absorbed of forward rays, and what befell them in optical elements
// (shaders/features/power_ledger.glsl).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/render/render_counters.h"
#include "host/scene/scene.h"

namespace etendue {

class PowerLedger {
  public:
    PowerLedger(Device& device, const Scene& scene);
    BufferTable buffers() const { return {{"PowerLedger", &sums_}}; }
    // Adds what there was since the last call, in the unit of RenderCounters::absorbed: by "material NAME"
    // and "medium NAME", and by the names of elements; of those of one name together. What has absorbed
    // nothing and was not entered is left out.
    void take(std::map<std::string, double>& absorbed_by, std::map<std::string, ElementPower>& elements);

  private:
    std::vector<std::string> names_;     // by place; empty = none is there
    std::vector<std::string> elements_;  // behind them
    Buffer sums_;
};

}  // namespace etendue
