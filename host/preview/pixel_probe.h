// What a receiver sees in one direction.
#pragma once
#include "host/preview/preview.h"

namespace etendue {

struct SeenPoint {
    bool hit = false;
    glm::dvec3 position{0};
    glm::vec3 normal{0};           // the normal is the shading normal
    float distance = 0;            // m
    uint32_t material = 0;         // index into SceneDescription::materials
    uint32_t surface = no_record;  // RecordRef
};

// Through a point of the film, [0, 1]², x to the right, y down.
SeenPoint see_point(PreviewScene& scene, const glm::dvec2& film);

}  // namespace etendue
