// The lights of a scene on the device in turn (result i is of light i modulo their count), asked for the rays
// it emits and for what the interface of shaders/interfaces/light_source.glsl says of the same rays seen from
// elsewhere.
#pragma once
#include "host/scene/scene.h"
#include "tests/support/device_fixture.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

struct ProbedRay {
    glm::vec3 origin;
    float pdf;
    glm::vec3 direction;
    float t_hit;  // m, to what the ray meets next; 1e30 = nothing
    glm::vec3 radiance;
    uint32_t is_delta;
    glm::vec3 normal;
    float met_pdf;  // pdf_emit of the light as met from further along the ray; -1 = a surface is missed
    glm::vec3 error;
    float met_radiance;  // luminance of light_radiance there; delta lights 0
    // sample_towards from there: its emission_pdf, and pdf_emit of the way it found; both -1 where it found
    // none
    float sampled_emission_pdf, sampled_met_pdf;
};

struct CrossingRay {
    glm::vec3 exit;  // on the sphere around the scene
    float pdf_emit;  // of the ray that leaves there
    glm::vec3 direction;
    float unused;
};

struct MeasuringDisk {
    glm::vec3 center, normal;
    float radius;
};

class EmissionProbe {
  public:
    explicit EmissionProbe(const SceneDescription& description);
    const Scene& scene() const { return scene_; }
    std::vector<ProbedRay> emit(uint32_t count, uint32_t seed);
    // Rays through the sphere around the scene, even over étendue.
    std::vector<CrossingRay> cross(uint32_t count, uint32_t seed);
    // pdf_emit of light that travels along each direction; of lights without a surface.
    std::vector<float> densities(const std::vector<glm::vec3>& directions);
    // Estimates of the mean illuminance of the disk's front by sample_towards, lx.
    std::vector<float> illuminances(const MeasuringDisk& disk, uint32_t count, uint32_t seed);

  private:
    template <class T>
    std::vector<T> run(uint32_t mode, uint32_t count, uint32_t seed, const char* results,
                       const std::vector<glm::vec3>& directions, const MeasuringDisk& disk);
    TemporaryFolder cache_;  // of the compiled kernel
    Scene scene_;
};

}  // namespace etendue
