// Surfaces that a scene gives as splines: their Bézier patches, which the class `bezier_patch` takes.
#pragma once
#include "host/gltf/json.h"

namespace etendue {

// Of {"degree": [p, q], "knots": [[…], […]], "control_points": [[x, y, z], …], "weights": […]}: the value of
// `control_points` of the same surface as rational bicubic patches, with u and v of the spline from 0 to 1.
// Members "class" and "material" are not looked at.
nlohmann::json patches_of_spline(const JsonAt& at);

}  // namespace etendue
