// What windows need to know of a receiver.
#pragma once
#include "host/preview/camera_control.h"
#include "host/scene/scene.h"

namespace etendue {

// Of a perspective or an orthographic camera; of another class as if its field of view were 45 degrees. The
// placement's own scale is left out of parallel rays' height.
CameraLens lens_of(const Receiver& receiver);

// What glTF says of it: {"cameras": […], "nodes": […]} with one of each.
nlohmann::json camera_as_gltf(const Receiver& receiver, double aspect_ratio);

}  // namespace etendue
