// Where things of a scene stand, as translation, rotation and scale that can be edited.
#pragma once
#include <nlohmann/json.hpp>

#include "host/scene/live_scene.h"

namespace etendue {

// Of all instances of meshes, then all shapes, then all lights.
LiveObject described_place(const SceneObjects& scene, uint32_t index);
size_t place_count(const SceneObjects& scene);

// `name`: translation (m), rotation (degrees about x, y and z, in this order), scale (of lights: none); three
// numbers each, null = as if there were none. What else the matrix does, such as shearing, stays.
void edit_place(SceneObjects& scene, uint32_t index, const std::string& name, const nlohmann::json& value);

}  // namespace etendue
