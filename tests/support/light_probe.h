// One light of a registered class on the device, asked through the interface of
// shaders/interfaces/light_source.glsl.
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "host/scene/classes.h"
#include "host/scene/description.h"
#include "host/scene/features.h"
#include "host/lights/light_tree.h"
#include "tests/support/device_fixture.h"

namespace etendue {

ShaderSources test_sources();

struct ProbeSample {
    glm::vec3 direction;
    float distance;
    glm::vec3 radiance;
    float pdf;
    glm::vec3 radiance_towards;  // light_radiance along the sampled direction
    float pdf_towards;           // light_pdf_towards of it
    uint32_t is_delta;
};

struct ProbeValue {
    glm::vec3 radiance;
    float pdf;
};

class LightProbe {
  public:
    LightProbe(const std::string& class_name, const nlohmann::json& parameters, const glm::dmat4& placement,
               const ImageDescription& image);
    std::vector<ProbeSample> sample(glm::vec3 point, uint32_t count, uint32_t seed);
    std::vector<ProbeSample> sample_at(const std::vector<glm::vec3>& points);  // one sample each
    std::vector<ProbeValue> evaluate(glm::vec3 point, const std::vector<glm::vec3>& directions);
    LightBounds measure(float scene_radius = 1.0f);  // by kernels/measure_lights.comp

  private:
    Kernel kernel(const std::string& name, const std::string& file, BufferTable buffers);
    ShaderSources sources_;
    Features features_;
    Buffer records_, texels_, photometric_, ray_words_, ray_colors_, lights_;
};

}  // namespace etendue
