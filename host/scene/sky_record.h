// What a scene says of its sky (shaders/lights/sky.glsl), checked.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "host/lights/sky.h"
#include "host/scene/classes.h"

namespace etendue {

// Unit vector towards the sun, by a direction or by place and time; null gives none, a vector of length 0.
// `place`: for messages.
glm::vec3 read_sun(const nlohmann::json& value, const std::string& place);

// Of a record of the class sky whose other parameters are filled. Fails where the sun that it needs is
// missing or below the horizon.
SkyParameters sky_parameters(const ClassInfo& info, const std::vector<std::byte>& record,
                             const std::string& place);

}  // namespace etendue
