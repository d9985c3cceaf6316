// What materials and media have absorbed of forward rays (shaders/features/power_ledger.glsl).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace etendue {

class PowerLedger {
  public:
    PowerLedger(Device& device, const Scene& scene);
    BufferTable buffers() const { return {{"PowerLedger", &sums_}}; }
    // Since the last call, in the unit of RenderCounters::absorbed, by "material NAME" and "medium NAME"; of
    // those of one name together. What has absorbed nothing is left out.
    std::map<std::string, double> take();

  private:
    std::vector<std::string> names_;  // by place; empty = none is there
    Buffer sums_;
};

}  // namespace etendue
