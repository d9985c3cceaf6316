// What a receiver sees through a pixel.
#pragma once
#include "host/preview/preview.h"

namespace etendue {

struct SeenPoint {
    bool hit = false;
    glm::dvec3 position{0};
    glm::vec3 normal{0};           // the shading normal
    float distance = 0;            // m
    uint32_t material = 0;         // index into SceneDescription::materials
    uint32_t surface = no_record;  // RecordRef
};

// Through a point of the film, [0, 1]², x to the right, y down.
SeenPoint see_point(PreviewScene& scene, const glm::dvec2& film);

struct PixelReading {
    glm::uvec2 pixel{0};  // of the window
    SeenPoint seen;
    std::string material, surface_class;
    std::vector<float> spectrum;  // W/(m² sr nm) in bins, where the film has any
};

PixelReading read_pixel(PreviewScene& scene, const glm::uvec2& pixel);

}  // namespace etendue
