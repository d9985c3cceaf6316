// Phase functions of one registered class on the device, asked through the interface of
// shaders/interfaces/phase_function.glsl.
#pragma once
#include <nlohmann/json.hpp>
#include <span>

#include "host/mie/mie_table.h"
#include "tests/support/surface_probe.h"

namespace etendue {

// Parameters that every registered class is tested with; none: the class is not known here.
std::vector<nlohmann::json> phase_configurations(const std::string& class_name);

// Of a record of the class mie, in vacuum.
MieParameters mie_parameters(const nlohmann::json& record);

class PhaseProbe {
  public:
    // One record for each of `parameters`. `nm`: what the lanes are, four wavelengths; else colours.
    PhaseProbe(ClassRegistry& registry, const std::string& class_name,
               const std::vector<nlohmann::json>& parameters, std::optional<glm::vec4> nm = {});
    int lanes() const { return lanes_; }
    std::vector<float> draw(size_t record, uint32_t count, uint32_t seed);  // cosines, at most 2^18
    std::vector<std::vector<float>> values(size_t record, std::span<const float> cosines);  // lanes of each
    std::vector<MuellerAnswer> polarize(size_t record, std::span<const MuellerQuery> queries);  // in colours

  private:
    int lanes_;
    Buffer records_, mie_values_, mie_sums_, wavelengths_, cosines_, samples_, values_, queries_, muellers_;
    std::vector<uint32_t> refs_;
    Kernel sample_, polarize_;
};

}  // namespace etendue
