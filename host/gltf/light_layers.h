// Layers of light as scenes and files of their own describe them (scenes/FORMAT.md, "Layers of light").
#pragma once
#include <vector>

#include "host/gltf/json.h"
#include "host/scene/description.h"

namespace etendue {

// Of an array. Fails with one line at what is wrong; whether the scene has the objects is not asked here.
std::vector<LightLayer> read_layers(const JsonAt& layers);

// The same, as it would be read.
nlohmann::json to_json(const std::vector<LightLayer>& layers);

}  // namespace etendue
