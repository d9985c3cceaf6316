// A measurement: what several meters of a scene read in the same passes, of the same forward rays.
#pragma once
#include <functional>
#include <memory>

#include "host/image/pass_set.h"
#include "host/measure/readings.h"

namespace etendue {

struct Measurement {
    std::vector<Readings> meters;
    PassSet passes;  // whole sixteens (`replicates`)
    RenderCounters counters;
    AlgorithmChoice choice;
    double seconds = 0;  // of rendering
    double power = 0;    // of the scene's lights, lm
};

// Adds passes to a measurement.
class MeasurementRun {
  public:
    // `settings`: what all meters have in common.
    MeasurementRun(Device& device, Scene& scene, const std::vector<const Receiver*>& receivers,
                   const RenderSettings& settings);
    ~MeasurementRun();

    // Passes [range.first, range.end), whole sixteens, of all meters. False: `interrupt` ended it, and
    // nothing was added.
    bool add(const PassRange& range, const std::function<bool()>& interrupt);

    // Where meters are dark that backward rays alone have read: whether forward rays reach them, and how many
    // did not. Returns the names of those that they do reach.
    std::vector<std::string> probe_dark_meters();

    const Measurement& measurement() const { return measurement_; }
    Measurement& measurement() { return measurement_; }
    const std::vector<LightLayer>& layers() const { return settings_.layers; }
    uint64_t rays() const { return all_rays(measurement_.counters); }

  private:
    Device& device_;
    Scene& scene_;
    RenderSettings settings_;                           // that all meters have in common
    std::vector<std::unique_ptr<Renderer>> renderers_;  // of most_views meters each, in their order
    Measurement measurement_;
};

}  // namespace etendue
