// Surfaces of one registered class on the device, asked through the interface of
// shaders/interfaces/surface_optics.glsl.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <span>

#include "host/scene/classes.h"
#include "tests/support/device_fixture.h"

namespace etendue {

// What surrounds a surface, as SurfaceContext has it.
struct SurfaceSurroundings {
    float ior_above = 1, ior_below = 1;
    bool importance = false;
    glm::vec4 color{1};
};

enum SurfaceEvent : uint32_t { event_reflect = 1, event_transmit = 2, event_delta = 4, event_straight = 8 };

struct SurfaceSample {
    glm::vec3 wi;
    float pdf;
    glm::vec3 weight;
    uint32_t event;
};

struct SurfaceSamples {
    std::vector<SurfaceSample> samples;
    glm::vec3 transparency;
    bool is_delta, is_opaque;
};

struct DirectionPair {
    glm::vec3 wo, wi;
};

struct SurfaceValue {
    glm::vec3 f_cos;
    float pdf, pdf_reverse;
};

// Light comes from `from` and goes to `to`; event 0 is one of `evaluate`.
struct MuellerQuery {
    glm::vec3 from, to;
    uint32_t event;
};

// As Mueller of shaders/lib/stokes.glsl.
struct MuellerAnswer {
    glm::vec3 from, to;
    std::array<glm::vec3, 16> m;
};

class SurfaceProbe {
  public:
    // One record for each of `parameters`. A texture parameter is {"value": [r, g, b, a]}: the same
    // everywhere.
    SurfaceProbe(ClassRegistry& registry, const std::string& class_name,
                 const std::vector<nlohmann::json>& parameters);
    SurfaceSamples sample(size_t record, const SurfaceSurroundings& at, glm::vec3 wo, uint32_t count,
                          uint32_t seed);
    std::vector<SurfaceValue> evaluate(size_t record, const SurfaceSurroundings& at,
                                       std::span<const DirectionPair> pairs);
    std::vector<MuellerAnswer> polarize(size_t record, const SurfaceSurroundings& at,
                                        std::span<const MuellerQuery> queries);

  private:
    Buffer records_, samples_, answers_, pairs_, values_, measured_points_, measured_colors_, queries_,
        muellers_, mueller_tables_, mueller_numbers_, mueller_intensities_, mueller_ratios_, grating_orders_,
        grating_numbers_;
    std::vector<uint32_t> refs_;
    Kernel sample_, evaluate_, polarize_;
};

// The text of a file under tests/kernels/.
std::string test_kernel_text(const std::string& name);

}  // namespace etendue
