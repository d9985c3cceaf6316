// Reads spectral values of the scene format.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "host/scene/description.h"
#include "host/spectra/spectral_value.h"

namespace etendue {

// Fails with the place and what is allowed.
SpectralValue spectral_value(const nlohmann::json& value, const SceneDescription& scene,
                             const std::string& where, SpectralKind kind);

// "FILE: /pointer": the start of a message about an object of the scene.
std::string message_place(const SceneDescription& scene, const std::string& where);

}  // namespace etendue
